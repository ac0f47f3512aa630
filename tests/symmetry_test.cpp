#include "meshgrain/symmetry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "has_note.h"
#include "made_fields.h"
#include "mesh/border.h"
#include "meshgrain/error.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "meshgrain/triangulate.h"
#include "same_topology.h"
#include "symmetry/border_in_planes.h"
#include "util/bounding_box.h"

namespace meshgrain {
namespace {

/// A blob's half and its mirror image, across x at `offset`.
Mesh symmetric_blob(float offset) {
  Mesh mesh = sample_shape("blob", 0.6);
  cut_at(mesh, {0, 0.1, 0});
  mesh.origin.setZero();
  add_mirror_image(mesh, 0, 1e-6);
  for (Vec3& p : mesh.positions) p.x() += offset;
  return mesh;
}

/// Whether each vertex has another, and each face another, where the mirror image of it is;
/// exactly.
void expect_symmetric(const Mesh& mesh, int axis) {
  std::map<std::array<float, 3>, Index> at;
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    at[{p.x(), p.y(), p.z()}] = v;
  }
  ASSERT_EQ(at.size(), mesh.positions.size());
  std::vector<Index> image;
  for (Vec3 p : mesh.positions) {
    p[axis] = -p[axis];
    const auto it = at.find({p.x(), p.y(), p.z()});
    ASSERT_NE(it, at.end());
    image.push_back(it->second);
  }
  std::set<std::vector<Index>> faces;
  std::vector<Index> corners;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    corners.assign(mesh.faces[f].begin(), mesh.faces[f].end());
    std::sort(corners.begin(), corners.end());
    faces.insert(corners);
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    corners.clear();
    for (const Index v : mesh.faces[f]) corners.push_back(image[v]);
    std::sort(corners.begin(), corners.end());
    EXPECT_TRUE(faces.contains(corners));
  }
}

TEST(Symmetry, ThePlaneIsFound) {
  const Mesh mesh = symmetric_blob(3);
  const MirrorPlane plane = find_mirror_plane(mesh, 0);
  EXPECT_NEAR(plane.offset, 3, 1e-3);
  EXPECT_LT(plane.mismatch, 1e-4);
  EXPECT_GT(find_mirror_plane(mesh, 1).mismatch, 0.01);
}

/// One vertex of a plate lies a little beyond the plane, those around it do not.
TEST(Symmetry, CrumbsOfACutAreDropped) {
  Mesh plate = triangulate(sample_shape("plate"));
  const Vec3 place(-0.3f, 0, 0);
  const auto nearer = [&](const Vec3& a, const Vec3& b) {
    return (a - place).norm() < (b - place).norm();
  };
  *std::ranges::min_element(plate.positions, nearer) = Vec3(0.01f, 0, 0.5f);
  cut_at(plate, {0, 0, 0});
  EXPECT_EQ(mesh_statistics(plate).components, 1u);
  EXPECT_NEAR(surface_area(plate), 0.5, 1e-3);
}

TEST(Symmetry, ResultsAreExactlySymmetric) {
  const Mesh mesh = symmetric_blob(3);
  for (const OutputFaces faces :
       {OutputFaces::quads, OutputFaces::quad_dominant, OutputFaces::triangles}) {
    SCOPED_TRACE(static_cast<int>(faces));
    RemeshOptions options;
    options.faces = faces;
    options.face_count = 1000;
    options.symmetry.automatic = true;
    const RemeshResult result = remesh(mesh, options);
    expect_symmetric(result.mesh, 0);
    EXPECT_NEAR(result.mesh.origin.x(), 3, 1e-3);
    const MeshStatistics s = mesh_statistics(result.mesh);
    made::expect_same_topology(s, mesh_statistics(mesh));
    EXPECT_NEAR(static_cast<double>(s.faces), 1000, 20);
    EXPECT_EQ(result.report.input_vertices, mesh.positions.size());
    EXPECT_LT(surface_distance(result.mesh, mesh, bounding_diagonal(mesh)).mean, 2e-3);
  }
}

/// A ring, as thick as `radius`, around z.
Mesh ring(float radius) {
  constexpr Index around = 120, across = 16;
  Mesh mesh;
  const auto angle = [](Index k, Index count) {
    return 2 * std::numbers::pi_v<float> * static_cast<float>(k) / static_cast<float>(count);
  };
  for (Index i = 0; i < around; ++i) {
    for (Index k = 0; k < across; ++k) {
      const float a = angle(i, around), b = angle(k, across);
      const float r = 1 + radius * std::cos(b);
      mesh.positions.emplace_back(r * std::cos(a), r * std::sin(a), radius * std::sin(b));
      const auto vertex = [&](Index di, Index dk) {
        return (i + di) % around * across + (k + dk) % across;
      };
      mesh.faces.push_back({vertex(0, 0), vertex(1, 0), vertex(1, 1), vertex(0, 1)});
    }
  }
  return mesh;
}

/// The halves of a ring are one face wide, or its ends in the plane are tiny.
TEST(Symmetry, ThinLimbsInThePlaneAndAcrossItAreKept) {
  for (const float radius : {0.06f, 0.2f}) {
    const Mesh input = ring(radius);
    for (const std::size_t count : {60, 140}) {
      for (const OutputFaces faces :
           {OutputFaces::quads, OutputFaces::quad_dominant, OutputFaces::triangles}) {
        for (const int axis : {0, 2}) {
          SCOPED_TRACE(std::to_string(radius) + " " + std::to_string(count) + " " +
                       std::to_string(static_cast<int>(faces)) + " " + std::to_string(axis));
          RemeshOptions options;
          options.faces = faces;
          options.face_count = count;
          options.symmetry.axes[axis] = true;
          const Mesh result = remesh(input, options).mesh;
          made::expect_same_topology(mesh_statistics(result), mesh_statistics(input));
          if (faces != OutputFaces::quad_dominant) {
            EXPECT_EQ(result.faces.uniform_degree(), faces == OutputFaces::quads ? 4u : 3u);
          }
        }
      }
    }
  }
}

TEST(Symmetry, SeveralPlanesAtOnce) {
  const Mesh mesh = sample_shape("torus");
  RemeshOptions options;
  options.face_count = 800;
  options.symmetry.axes = {true, true, true};
  const Mesh result = remesh(mesh, options).mesh;
  for (const int axis : {0, 1, 2}) expect_symmetric(result, axis);
  made::expect_same_topology(mesh_statistics(result), mesh_statistics(mesh));
}

/// The result is that without the option, and says why.
/// Of so few faces an eighth has hardly one in each of its planes.
TEST(Symmetry, FewFacesKeepTheTopology) {
  for (const char* name : {"torus", "three-holes"}) {
    const Mesh shape = sample_shape(name);
    for (const std::size_t faces : {20u, 40u}) {
      SCOPED_TRACE(std::string(name) + " of " + std::to_string(faces));
      RemeshOptions options;
      options.faces = OutputFaces::quad_dominant;
      options.face_count = faces;
      options.symmetry.axes = {true, std::string(name) == "torus", true};
      const RemeshResult result = remesh(shape, options);
      made::expect_same_topology(mesh_statistics(result.mesh), mesh_statistics(shape));
      EXPECT_FALSE(made::has_note(result, "the halves"));
    }
  }
}

TEST(Symmetry, WhatIsNotSymmetricStaysWhole) {
  const Mesh mesh = symmetric_blob(0);
  RemeshOptions options;
  options.face_count = 500;
  const Mesh plain = remesh(mesh, options).mesh;
  options.symmetry.axes[1] = true;
  const RemeshResult result = remesh(mesh, options);
  EXPECT_EQ(result.mesh.positions, plain.positions);
  EXPECT_EQ(result.report.notes, std::vector<std::string>{"not symmetric across y"});
}

/// A flat mesh is its own mirror image in the plane that it lies in.
TEST(Symmetry, WhatLiesInThePlaneStaysWhole) {
  const Mesh mesh = made::grid(20, 20, false, false, [](double u, double v) {
    return Vec3(2 * static_cast<float>(u), static_cast<float>(v), 0);
  });
  RemeshOptions options;
  options.face_count = 500;
  const Mesh plain = remesh(mesh, options).mesh;
  options.symmetry.axes[2] = true;
  EXPECT_EQ(remesh(mesh, options).mesh.positions, plain.positions);
  options.symmetry.axes[0] = true;
  const RemeshResult result = remesh(mesh, options);
  expect_symmetric(result.mesh, 0);
  EXPECT_EQ(result.report.notes, std::vector<std::string>{"made symmetric across x"});
}

/// As a fin is that stands between both halves.
TEST(Symmetry, TellsWhatIsLeftOutInThePlane) {
  Mesh mesh = sample_shape("torus");
  for (const Vec3& p : {Vec3(0, -3, -3), Vec3(0, 3, -3), Vec3(0, 0, -2)}) {
    mesh.positions.push_back(p);
  }
  const auto last = static_cast<Index>(mesh.positions.size() - 1);
  mesh.faces.push_back({last - 2, last - 1, last});
  RemeshOptions options;
  options.face_count = 500;
  options.symmetry.axes[0] = true;
  const std::vector<std::string> notes = remesh(mesh, options).report.notes;
  ASSERT_FALSE(notes.empty());
  EXPECT_EQ(notes[0], "left out 1 faces in the mirror plane across x");
}

/// One half of a plate has a small hole.
TEST(Symmetry, TellsThatHalvesAreNotAlike) {
  Mesh plate = made::grid(40, 20, false, false, [](double u, double v) {
    return Vec3(2 * static_cast<float>(u) - 1, static_cast<float>(v), 0);
  });
  RemeshOptions options;
  options.face_count = 500;
  options.symmetry.axes[0] = true;
  EXPECT_EQ(remesh(plate, options).report.notes.size(), 1u);
  Faces kept;
  for (std::size_t f = 0; f < plate.faces.size(); ++f) {
    const auto face = std::as_const(plate.faces)[f];
    const bool is_at_hole = std::ranges::any_of(
        face, [&](Index v) { return (plate.positions[v] - Vec3(0.5f, 0.5f, 0)).norm() < 0.01f; });
    if (!is_at_hole) kept.push_back(face);
  }
  plate.faces = std::move(kept);
  const RemeshResult result = remesh(plate, options);
  ASSERT_EQ(result.report.notes.size(), 3u);  // one for the vertex in the hole
  EXPECT_TRUE(result.report.notes[2].starts_with("the halves of the input are not alike"));
}

/// Where faces are to be small near a point, the point's mirror image does as well.
TEST(Symmetry, ThePointOfASizingMayLieOnEitherSide) {
  const Mesh mesh = symmetric_blob(3);
  RemeshOptions options;
  options.face_count = 600;
  options.symmetry.axes[0] = true;
  options.sizing.kind = Sizing::Kind::distance;
  options.sizing.point = {4, 0, 0};
  const Mesh near = remesh(mesh, options).mesh;
  options.sizing.point = {2, 0, 0};
  const Mesh other = remesh(mesh, options).mesh;
  const auto distance = surface_distance(near, other, bounding_diagonal(mesh));
  EXPECT_LT(distance.max, 5e-3);
  EXPECT_NEAR(static_cast<double>(near.faces.size()), 600, 12);
  EXPECT_GT(mesh_statistics(near).area_sigma, 0.3);
  EXPECT_NEAR(mesh_statistics(near).area_sigma, mesh_statistics(other).area_sigma, 0.05);
}

/// What was mended of the input is told, as without symmetry.
TEST(Symmetry, TellsWhatWasMended) {
  Mesh mesh = symmetric_blob(0);
  mesh.faces.push_back({mesh.faces[0][0], mesh.faces[0][0], mesh.faces[0][1]});
  RemeshOptions options;
  options.face_count = 400;
  const std::vector<std::string> plain = remesh(mesh, options).report.notes;
  options.symmetry.automatic = true;
  std::vector<std::string> notes = remesh(mesh, options).report.notes;
  ASSERT_FALSE(notes.empty());
  EXPECT_EQ(notes.back(), "made symmetric across x");
  notes.pop_back();
  EXPECT_EQ(notes, plain);
  EXPECT_FALSE(plain.empty());
}

/// Even if it has strayed from them by more than the sides of faces, as on parts few faces wide.
TEST(Symmetry, NothingStaysOpenBetweenTwoPlanes) {
  Mesh mesh = ring(0.3f);
  const MeshStatistics whole = mesh_statistics(mesh);
  const std::vector<MirrorPlane> planes{{0, 0, 0}, {1, 0, 0}};
  EXPECT_FALSE(has_border_in_planes_only(triangulate(sample_shape("plate")), planes, Context()));
  for (const MirrorPlane& plane : planes) cut_at(mesh, plane);
  EXPECT_TRUE(has_border_in_planes_only(mesh, planes, Context()));
  for (const auto& edge : border_edges(mesh)) {
    Vec3& p = mesh.positions[edge[0]];
    (p.x() < p.y() ? p.x() : p.y()) += 0.05f * static_cast<float>(edge[0] % 3);
  }
  EXPECT_FALSE(has_border_in_planes_only(mesh, planes, Context()));
  put_border_into_planes(mesh, planes, Context());
  for (const MirrorPlane& plane : planes) add_mirror_image(mesh, plane.axis, 1e-6);
  made::expect_same_topology(mesh_statistics(mesh), whole);
}

/// Those in the planes are not there twice.
TEST(Symmetry, VerticesAreCountedOnce) {
  RemeshOptions options;
  options.vertex_count = 1000;
  for (const bool across_z : {false, true}) {
    options.symmetry = {.axes = {true, false, across_z}};
    const RemeshResult result = remesh(ring(0.3f), options);
    EXPECT_NEAR(static_cast<double>(result.mesh.positions.size()), 1000, 25);
  }
}

/// As a whole it is nearly symmetric, but a half has no horn, or the result would have two.
TEST(Symmetry, AHornOnOneSideIsNotLost) {
  Mesh mesh = symmetric_blob(0);
  constexpr float width = 0.15f, length = 0.5f;
  float tip = 0;
  for (Vec3& p : mesh.positions) {
    const float across = std::hypot(p.y(), p.z()) / width;
    if (p.x() > 0 && across < 1) p.x() += length * (1 - across * across);
    tip = std::max(tip, p.x());
  }
  const MirrorPlane plane = find_mirror_plane(mesh, 0);
  EXPECT_LT(plane.mismatch, 0.01);
  EXPECT_GT(plane.unlike, 0.001);
  RemeshOptions options;
  options.face_count = 1000;
  const auto range_of = [](const RemeshResult& result) {
    const auto box = bounding_box(result.mesh.positions, Context());
    const double x = result.mesh.origin.x();
    return std::pair(box.min().x() + x, box.max().x() + x);
  };
  options.symmetry.automatic = true;
  const RemeshResult whole = remesh(mesh, options);
  EXPECT_EQ(whole.report.notes.back(), "not symmetric across x, y or z");
  EXPECT_NEAR(range_of(whole).second, tip, 0.25 * length);
  EXPECT_GT(range_of(whole).first, -tip + 0.5 * length);
  options.symmetry = {.axes = {true, false, false}};
  const RemeshResult doubled = remesh(mesh, options);
  EXPECT_LT(range_of(doubled).first, -tip + 0.5 * length);
  EXPECT_TRUE(std::ranges::any_of(doubled.report.notes, [](const std::string& note) {
    return note.find("nothing like it across x") != std::string::npos;
  }));
}

TEST(Symmetry, NeedsASurface) {
  Mesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0)};
  mesh.faces.push_back({0, 1, 0});
  RemeshOptions options;
  options.symmetry.automatic = true;
  EXPECT_THROW(remesh(mesh, options), Error);
}

TEST(Symmetry, NeedsFieldsOverVertices) {
  RemeshOptions options;
  options.symmetry.automatic = true;
  options.graph.nodes = GraphNodes::faces;
  EXPECT_THROW(remesh(symmetric_blob(0), options), Error);
}

TEST(Symmetry, NeedsAMesh) {
  Mesh cloud = sample_shape("blob", 0.3);
  cloud.faces.clear();
  RemeshOptions options;
  options.symmetry.automatic = true;
  EXPECT_THROW(remesh(cloud, options), Error);
}

}  // namespace
}  // namespace meshgrain
