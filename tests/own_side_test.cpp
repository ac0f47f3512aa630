#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "finish/near_surface.h"
#include "finish/vertex_batches.h"
#include "measure/bvh.h"
#include "mesh/box_cells.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

/// The unit sphere made flat.
Mesh lens(float thickness) {
  Mesh mesh = sample_shape("sphere");
  for (Vec3& p : mesh.positions) p.z() *= thickness;
  return mesh;
}

/// The share of a mesh's area that is nearest to what looks the other way.
double turned_share(const Mesh& mesh, const Mesh& surface) {
  constexpr int side = 7;
  const Bvh tree(surface);
  const std::vector<Triangle> triangles = triangles_of(surface);
  const auto normal_of = [](const Mesh& m, Index a, Index b, Index c) -> Eigen::Vector3d {
    const auto at = [&](Index v) { return Eigen::Vector3d(m.positions[v].cast<double>()); };
    return (at(b) - at(a)).cross(at(c) - at(a));
  };
  double turned = 0, all = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    for (std::size_t k = 2; k < face.size(); ++k) {
      const Vec3 &a = mesh.positions[face[0]], &b = mesh.positions[face[k - 1]],
                 &c = mesh.positions[face[k]];
      const Eigen::Vector3d normal = normal_of(mesh, face[0], face[k - 1], face[k]);
      for (int i = 0; i < side; ++i) {
        for (int j = 0; i + j < side; ++j) {
          const float x = (static_cast<float>(i) + 1 / 3.0f) / side;
          const float y = (static_cast<float>(j) + 1 / 3.0f) / side;
          const Vec3 p = a + x * (b - a) + y * (c - a);
          const auto& [u, v, w] = triangles[tree.closest(p.cast<double>()).triangle];
          if (normal_of(surface, u, v, w).dot(normal) < 0) turned += normal.norm();
          all += normal.norm();
        }
      }
    }
  }
  return turned / all;
}

/// Vertices on the surface alone would leave two to five times as much on the wrong side.
TEST(OwnSide, LittleOfAThinShapeLooksTheOtherWay) {
  struct Case {
    float thickness;
    std::size_t faces;
    double most_turned, farthest;  // in the mean
  };
  const Case cases[] = {{0.1f, 300, 0.015, 0.007},    {0.1f, 1000, 0.006, 0.0025},
                        {0.1f, 4000, 0.0008, 0.0008}, {0.05f, 300, 0.025, 0.005},
                        {0.05f, 1000, 0.012, 0.0015}, {0.05f, 4000, 0.005, 0.0005}};
  for (const Case& c : cases) {
    SCOPED_TRACE(testing::Message() << c.faces << " faces of a lens as thick as " << c.thickness);
    const Mesh shape = lens(c.thickness);
    RemeshOptions options;
    options.face_count = c.faces;
    const Mesh result = remesh(shape, options).mesh;
    const MeshStatistics s = mesh_statistics(result);
    made::expect_same_topology(s, mesh_statistics(shape));
    EXPECT_EQ(s.inverted_quads, 0u);
    EXPECT_LT(turned_share(result, shape), c.most_turned);
    EXPECT_LT(surface_distance(result, shape, 1, 20000).mean, c.farthest);
  }
}

TEST(BoxCells, HoldWhatIsInTheBoxes) {
  std::vector<Eigen::AlignedBox3f> boxes;
  for (int k = 0; k < 20; ++k) {
    const Vec3 low(0.37f * static_cast<float>(k * k % 19), 0.53f * static_cast<float>(k), 0);
    boxes.emplace_back(low, low + Vec3(0.2f, 0.7f, 0.1f * static_cast<float>(k)));
  }
  const BoxCells cells(boxes, 0.25f);
  for (const auto& box : boxes) {
    EXPECT_TRUE(cells.contains(box.min()));
    EXPECT_TRUE(cells.contains(box.max()));
    EXPECT_TRUE(cells.contains(box.center()));
    EXPECT_TRUE(cells.touches(box));
    EXPECT_TRUE(cells.touches({box.max(), box.max() + Vec3::Ones()}));
  }
  EXPECT_FALSE(cells.contains(Vec3(3, -0.1f, 0)));
  EXPECT_FALSE(cells.touches({Vec3(0, 0, 2.5f), Vec3(9, 9, 3)}));
  // Between the first box and the next ones along y.
  EXPECT_FALSE(cells.touches({Vec3(5, 0, 0), Vec3(6, 0.2f, 0.1f)}));
  EXPECT_FALSE(BoxCells({}, 1).contains(Vec3::Zero()));
  EXPECT_FALSE(BoxCells({}, 1).touches({Vec3::Zero(), Vec3::Ones()}));
}

/// Two sheets back to back.
TEST(NearSurface, SeesEverySide) {
  Mesh surface;
  for (const float z : {0.0f, -0.1f}) {
    const auto first = static_cast<Index>(surface.positions.size());
    for (const auto& [x, y] : {std::pair(-1.0f, -1.0f), {1.0f, -1.0f}, {0.0f, 1.0f}}) {
      surface.positions.push_back(Vec3(x, y, z));
    }
    const Index second = first + (z < 0 ? 2 : 1);
    surface.faces.push_back({first, second, 2 * first + 3 - second});
  }
  // One that is not near.
  surface.positions.insert(surface.positions.end(), {Vec3(9, 0, 0), Vec3(10, 0, 0), Vec3(9, 1, 0)});
  surface.faces.push_back({6, 7, 8});
  const std::vector<Eigen::AlignedBox3f> boxes{{Vec3(-1, -1, -0.1f), Vec3(1, 1, 0)}};
  const NearSurface near(surface, BoxCells(boxes, 0.25f), Context());
  const auto above = near.nearest(Vec3(0, 0, -0.04f), 1);
  EXPECT_FLOAT_EQ(above.distance, 0.04f);
  EXPECT_EQ(above.normal, Vec3::UnitZ());
  const auto below = near.nearest(Vec3(0, 0, -0.08f), 1);
  EXPECT_NEAR(below.distance, 0.02f, 1e-6f);
  EXPECT_EQ(below.normal, -Vec3::UnitZ());
  const auto none = near.nearest(Vec3(0, 0, 0.5f), 0.4f);
  EXPECT_EQ(none.distance, 0.4f);
  EXPECT_TRUE(none.normal.isZero());
  EXPECT_EQ(near.nearest(Vec3(9.2f, 0.2f, 0), 1).distance, 1);
}

TEST(VertexBatches, ShareNoFace) {
  const Mesh mesh = sample_shape("three-holes");
  const VertexFaces around = vertex_faces(mesh);
  std::vector<Index> vertices;
  for (Index v = 0; v < mesh.positions.size(); v += 2) vertices.push_back(v);
  VertexBatches batches(mesh, around);
  std::vector<Index> all;
  for (const auto& batch : batches(vertices)) {
    std::vector<Index> faces;
    for (const Index v : batch) faces.insert(faces.end(), around[v].begin(), around[v].end());
    std::ranges::sort(faces);
    EXPECT_EQ(std::ranges::adjacent_find(faces), faces.end());
    all.insert(all.end(), batch.begin(), batch.end());
  }
  std::ranges::sort(all);
  EXPECT_EQ(all, vertices);
}

}  // namespace
}  // namespace meshgrain
