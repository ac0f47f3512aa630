#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "has_note.h"
#include "made_volume.h"
#include "measure/crossings.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

/// Goes straight through a mesh from one triangle to another, which it takes the place of.
void drill(Mesh& mesh, std::size_t from, std::size_t to) {
  const auto corners = [&](std::size_t f) {
    const auto face = std::as_const(mesh.faces)[f];
    return std::array{face[0], face[1], face[2]};
  };
  const std::array a = corners(from);
  std::array b = corners(to);
  std::ranges::reverse(b);
  const auto length = [&] {
    float sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += (mesh.positions[a[k]] - mesh.positions[b[k]]).norm();
    return sum;
  };
  std::array best = b;
  float least = length();
  for (int turn = 0; turn < 2; ++turn) {
    std::ranges::rotate(b, b.begin() + 1);
    if (length() < least) least = length(), best = b;
  }
  Faces faces;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (f != from && f != to) faces.push_back(std::as_const(mesh.faces)[f]);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    faces.push_back({a[k], a[next], best[next]});
    faces.push_back({a[k], best[next], best[k]});
  }
  mesh.faces = std::move(faces);
}

/// The triangle of a sphere that is farthest in a direction.
std::size_t face_towards(const Mesh& mesh, const Vec3& direction) {
  std::size_t best = 0;
  float most = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Vec3 middle = Vec3::Zero();
    for (const Index v : mesh.faces[f]) middle += mesh.positions[v];
    if (middle.dot(direction) > most) most = middle.dot(direction), best = f;
  }
  return best;
}

/// A bore far narrower than a face, close below the surface of a ball.
Mesh drilled_ball() {
  Mesh mesh = sample_shape("sphere", 0.7);
  drill(mesh, face_towards(mesh, Vec3(1, 0, 0)), face_towards(mesh, Vec3(0.697f, 0.717f, 0)));
  return mesh;
}

TEST(FinerFaces, ABoreNarrowerThanAFaceStaysAndNothingCrosses) {
  const Mesh ball = drilled_ball();
  ASSERT_EQ(mesh_statistics(ball).euler, 0);
  RemeshOptions options;
  options.face_count = 300;
  const RemeshResult result = remesh(ball, options);
  const MeshStatistics s = mesh_statistics(result.mesh);
  made::expect_same_topology(s, mesh_statistics(ball));
  EXPECT_EQ(s.inverted_quads, 0u);
  EXPECT_NEAR(static_cast<double>(s.faces), 300, 3);
  EXPECT_TRUE(find_crossings(result.mesh, Context()).empty());
  EXPECT_TRUE(made::has_note(result, "made faces smaller"));
  EXPECT_EQ(result.report.input_vertices, ball.positions.size());
  EXPECT_TRUE(result.fields.surface.values.empty());
}

/// Nor are there others where memory is short.
TEST(FinerFaces, WithoutRetriesTheFirstFacesStay) {
  const Mesh ball = drilled_ball();
  RemeshOptions options;
  options.face_count = 300;
  options.retries = false;
  const RemeshResult first = remesh(ball, options);
  made::expect_same_topology(mesh_statistics(first.mesh), mesh_statistics(ball));
  EXPECT_FALSE(find_crossings(first.mesh).empty());
  ASSERT_EQ(first.report.notes.size(), 1u);
  EXPECT_TRUE(first.report.notes[0].starts_with("could not avoid"));
  options.retries = true;
  options.memory_limit = std::size_t{40} << 20;
  EXPECT_EQ(remesh(ball, options).mesh.positions, first.mesh.positions);
}

/// Gives a mesh around the origin a fin that stands on it, along edges from the vertex that is
/// farthest in a direction: always on to the neighbour that is farthest along.
void add_fin(Mesh& mesh, const Vec3& from, const Vec3& along, std::size_t edges) {
  const auto farthest = [&](std::span<const Index> vertices, const Vec3& direction) {
    return *std::ranges::max_element(vertices, {},
                                     [&](Index v) { return mesh.positions[v].dot(direction); });
  };
  std::vector<Index> all(mesh.positions.size());
  std::iota(all.begin(), all.end(), Index{0});
  std::vector<Index> foot{farthest(all, from)};
  for (std::size_t k = 0; k < edges; ++k) {
    std::vector<Index> neighbours;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto face = std::as_const(mesh.faces)[f];
      if (std::ranges::find(face, foot.back()) == face.end()) continue;
      neighbours.insert(neighbours.end(), face.begin(), face.end());
    }
    foot.push_back(farthest(neighbours, along));
  }
  const auto top = static_cast<Index>(mesh.positions.size());
  for (const Index v : foot) mesh.positions.push_back(1.5f * mesh.positions[v]);
  for (Index k = 0; k < edges; ++k) {
    mesh.faces.push_back({foot[k], foot[k + 1], top + k + 1});
    mesh.faces.push_back({foot[k], top + k + 1, top + k});
  }
}

/// Whatever is made in place of the first faces.
TEST(FinerFaces, PiecesThatMeetOnEdgesStillMeet) {
  Mesh ball = drilled_ball();
  add_fin(ball, Vec3(-1, 0, 0), Vec3(0, 0, 1), 8);
  ASSERT_EQ(mesh_statistics(ball).non_manifold_edges, 8u);
  for (const auto& [count, creases, note] :
       {std::tuple(500, Creases::automatic, "made faces smaller"),
        {300, Creases::none, "closed 1 tunnel"}}) {
    RemeshOptions options;
    options.face_count = count;
    options.features.creases = creases;
    const RemeshResult result = remesh(ball, options);
    EXPECT_TRUE(made::has_note(result, note)) << note;
    const MeshStatistics s = mesh_statistics(result.mesh);
    EXPECT_EQ(s.components, 1u) << note;
    EXPECT_GT(s.non_manifold_edges, 2u) << note;
    EXPECT_EQ(s.inverted_quads, 0u) << note;
  }
}

/// Edges that are a quarter as long around all of these bores would be twice as long elsewhere.
TEST(FinerFaces, ShapesElsewhereAreNoPriceForFewerCrossings) {
  Mesh ball = sample_shape("sphere", 0.7);
  for (const auto& [from, aside] : {std::pair(Vec3(1, 0, 0), Vec3(0, 0, 1)),
                                    {Vec3(-1, 0, 0), Vec3(0, 0, -1)},
                                    {Vec3(0, 1, 0), Vec3(1, 0, 0)}}) {
    drill(ball, face_towards(ball, from), face_towards(ball, 0.697f * from + 0.717f * aside));
  }
  RemeshOptions options;
  options.face_count = 600;
  const MeshStatistics s = mesh_statistics(remesh(ball, options).mesh);
  made::expect_same_topology(s, mesh_statistics(ball));
  EXPECT_EQ(s.inverted_quads, 0u);
  EXPECT_NEAR(static_cast<double>(s.faces), 600, 6);
  EXPECT_LT(s.area_max, 4);
}

/// Struts around the edges of cubes, as of a printed lattice.
Mesh struts(int cubes, double radius, int cells) {
  const auto distance = [&](const Eigen::Vector3d& p) {
    const double width = 1.6 / cubes;
    std::array<double, 3> away;  // from the nearest of the planes that the struts lie in
    for (int k = 0; k < 3; ++k) {
      const double x = std::clamp(std::round((p[k] + 0.8) / width), 0.0, double(cubes));
      away[k] = std::abs(p[k] + 0.8 - x * width);
    }
    std::ranges::sort(away);
    const bool is_beyond = p.cwiseAbs().maxCoeff() > 0.8;
    return is_beyond ? std::hypot(std::hypot(away[0], away[1]), away[2]) - radius
                     : std::hypot(away[0], away[1]) - radius;
  };
  return made::sampled_on_grid(distance, cells);
}

/// Two faces around each strut are none that can be valid.
TEST(MoreFaces, AreMadeWhereSoFewWouldBeInverted) {
  const Mesh input = struts(1, 0.1, 30);
  RemeshOptions options;
  options.face_count = 50;
  options.features.creases = Creases::none;
  const RemeshResult result = remesh(input, options);
  const MeshStatistics now = mesh_statistics(result.mesh);
  EXPECT_EQ(now.inverted_quads, 0u);
  EXPECT_GT(now.faces, 2 * options.face_count - 10);
  EXPECT_TRUE(made::has_note(result, "made more faces"));
  made::expect_same_topology(now, mesh_statistics(input));
  options.retries = false;
  EXPECT_GT(mesh_statistics(remesh(input, options).mesh).inverted_quads, 0u);
}

}  // namespace
}  // namespace meshgrain
