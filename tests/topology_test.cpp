#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "has_note.h"
#include "made_cells.h"
#include "made_fields.h"
#include "measure/crossings.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "same_topology.h"
#include "util/hash.h"

namespace meshgrain {
namespace {

/// What the README guarantees of manifold, orientable input: the same pieces, borders and genus,
/// manifold and consistently oriented, no isolated vertices, and only the faces asked for. Also at
/// targets far too coarse for the shape.
TEST(Topology, IsThatOfTheInput) {
  for (const std::string& name : sample_names()) {
    const Mesh input = sample_shape(name, 0.5);
    const MeshStatistics before = mesh_statistics(input);
    for (const OutputFaces faces :
         {OutputFaces::quads, OutputFaces::quad_dominant, OutputFaces::triangles}) {
      for (const std::size_t count : {40, 800}) {
        SCOPED_TRACE(name + " " + std::to_string(static_cast<int>(faces)) + " " +
                     std::to_string(count));
        RemeshOptions options;
        options.faces = faces;
        options.face_count = count;
        const Mesh result = remesh(input, options).mesh;
        const MeshStatistics after = mesh_statistics(result);
        made::expect_same_topology(after, before);
        if (faces == OutputFaces::quads) {
          EXPECT_EQ(after.quads, after.faces);
        }
        if (faces == OutputFaces::triangles) {
          EXPECT_EQ(after.triangles, after.faces);
        }
        // Consistently oriented: no two faces run along an edge the same way.
        std::vector<std::pair<Index, Index>> halfedges;
        for (std::size_t f = 0; f < result.faces.size(); ++f) {
          const auto face = result.faces[f];
          for (std::size_t k = 0; k < face.size(); ++k) {
            halfedges.emplace_back(face[k], face[(k + 1) % face.size()]);
          }
        }
        std::ranges::sort(halfedges);
        EXPECT_EQ(std::ranges::adjacent_find(halfedges), halfedges.end());
      }
    }
  }
}

/// A piece without room for one face comes back, closed, unless it is not wanted.
TEST(Topology, SmallPiecesStayUnlessTheyAreNotWanted) {
  Mesh both = sample_shape("sphere");
  const Mesh small = sample_shape("sphere", 0.3);
  const auto first = static_cast<Index>(both.positions.size());
  for (const Vec3& p : small.positions) both.positions.push_back(0.02f * p + Vec3(3, 0, 0));
  for (std::size_t f = 0; f < small.faces.size(); ++f) {
    std::vector<Index> face(small.faces[f].begin(), small.faces[f].end());
    for (Index& v : face) v += first;
    both.faces.push_back(face);
  }
  RemeshOptions options;
  options.face_count = 1000;
  const RemeshResult kept = remesh(both, options);
  made::expect_same_topology(mesh_statistics(kept.mesh), mesh_statistics(both));
  options.min_component = 5;
  const RemeshResult dropped = remesh(both, options);
  made::expect_same_topology(mesh_statistics(dropped.mesh),
                             mesh_statistics(sample_shape("sphere")));
  EXPECT_EQ(dropped.report.notes.size(), kept.report.notes.size() + 1);
}

/// A dense sphere like a scan with many faults: without every k-th triangle, which floats beside
/// it.
Mesh faulty_scan(std::size_t k) {
  const Mesh sphere = sample_shape("sphere", 3);
  Mesh scan;
  scan.positions = sphere.positions;
  for (std::size_t f = 0; f < sphere.faces.size(); ++f) {
    const auto face = sphere.faces[f];
    if (f % k != 0) {
      scan.faces.push_back(face);
      continue;
    }
    const auto first = static_cast<Index>(scan.positions.size());
    for (const Index v : face) scan.positions.push_back(1.05f * sphere.positions[v]);
    scan.faces.push_back({first, first + 1, first + 2});
  }
  return scan;
}

/// A sheet without one face in ten, chosen by a hash: many of the holes touch others at a vertex.
TEST(Topology, HolesThatTouchDoNotBecomeOne) {
  const Mesh sheet = made::grid(24, 24, false, false, [](double u, double v) {
    return Vec3(static_cast<float>(u), static_cast<float>(v), static_cast<float>(u * (1 - u)));
  });
  Mesh input;
  input.positions = sheet.positions;
  for (std::size_t f = 0; f < sheet.faces.size(); ++f) {
    if (hash64(f) % 10 != 0) input.faces.push_back(sheet.faces[f]);
  }
  const MeshStatistics before = mesh_statistics(input);
  ASSERT_EQ(before.non_manifold_edges, 0u);
  ASSERT_GT(before.non_manifold_vertices, 10u);
  for (const std::size_t count : {100, 500}) {
    SCOPED_TRACE(count);
    RemeshOptions options;
    options.face_count = count;
    const MeshStatistics after = mesh_statistics(remesh(input, options).mesh);
    EXPECT_EQ(after.non_manifold_edges, 0u);
    EXPECT_EQ(after.boundary_loops, before.boundary_loops);
  }
}

/// What is made of pieces that meet along edges of more than two faces, with some luck and other.
void expect_to_meet(const Mesh& input, std::span<const std::size_t> counts) {
  const MeshStatistics before = mesh_statistics(input);
  for (const OutputFaces faces :
       {OutputFaces::quads, OutputFaces::quad_dominant, OutputFaces::triangles}) {
    for (const std::size_t count : counts) {
      for (const std::uint64_t seed : {0, 1, 2}) {
        SCOPED_TRACE(std::to_string(static_cast<int>(faces)) + " " + std::to_string(count) + " " +
                     std::to_string(seed));
        RemeshOptions options;
        options.faces = faces;
        options.face_count = count;
        options.solver.seed = seed;
        const RemeshResult result = remesh(input, options);
        const MeshStatistics after = mesh_statistics(result.mesh);
        EXPECT_EQ(after.components, before.components);
        EXPECT_EQ(after.boundary_loops, before.boundary_loops);
        EXPECT_GE(after.non_manifold_edges, 3u);
        EXPECT_EQ(after.inverted_quads, 0u);
        EXPECT_TRUE(find_crossings(result.mesh, Context()).empty());
        // All faces lie on their own piece, up to its ends.
        EXPECT_LT(surface_distance(input, result.mesh, 1, 20000).max, 0.03);
        EXPECT_LT(surface_distance(result.mesh, input, 1, 20000).max, 0.03);
        const auto wanted = static_cast<double>(count);
        EXPECT_NEAR(static_cast<double>(after.faces), wanted, 0.0101 * wanted);
      }
    }
  }
}

/// Two cubes that share an edge: each is whole, creases and all, and both have the same vertices
/// along it.
TEST(Topology, PiecesThatMeetAlongAnEdgeLeaveNoCrack) {
  const Mesh cubes = made::surface_of_cells({{0, 0, 0}, {1, 1, 0}});
  ASSERT_EQ(mesh_statistics(cubes).boundary_loops, 0u);
  ASSERT_EQ(mesh_statistics(cubes).non_manifold_edges, 1u);
  expect_to_meet(cubes, std::array<std::size_t, 2>{500, 1500});
}

/// A ball on which smaller ones stand, each on a single vertex.
TEST(Topology, PiecesThatTouchAtAVertexMeet) {
  const Mesh ball = sample_shape("sphere", 0.5);
  Mesh balls = ball;
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
    const auto farthest = [&](const Vec3& direction) {
      return static_cast<Index>(
          std::ranges::max_element(ball.positions, {},
                                   [&](const Vec3& p) { return p.dot(direction); }) -
          ball.positions.begin());
    };
    const Index foot = farthest(way), own = farthest(-way);
    const auto first = static_cast<Index>(balls.positions.size());
    for (const Vec3& p : ball.positions) {
      balls.positions.push_back(ball.positions[foot] + 0.15f * (p - ball.positions[own]));
    }
    for (Index f = 0; f < ball.faces.size(); ++f) {
      std::array<Index, 3> face;
      std::ranges::transform(ball.faces[f], face.begin(),
                             [&](Index v) { return v == own ? foot : first + v; });
      balls.faces.push_back(face);
    }
  }
  for (const std::size_t count : {300, 1000, 3000}) {
    RemeshOptions options;
    options.face_count = count;
    const MeshStatistics after = mesh_statistics(remesh(balls, options).mesh);
    EXPECT_EQ(after.components, 1u) << count;
    EXPECT_EQ(after.non_manifold_vertices, 4u) << count;
    EXPECT_EQ(after.inverted_quads, 0u) << count;
  }
}

TEST(Topology, StairsOfCubesMeet) {
  expect_to_meet(made::surface_of_cells({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 0}}),
                 std::array<std::size_t, 1>{1500});
}

/// A tube goes on past the disc in its middle, whose border ends at it.
TEST(Topology, AMembraneMeetsItsTube) {
  expect_to_meet(made::tube_with_membrane(), std::array<std::size_t, 1>{1000});
}

/// Where the surface is far finer than the faces, as where it is for more of them as well.
TEST(Topology, PiecesMeetAtAllLevels) {
  for (const Mesh& input :
       {made::tube_with_membrane(), made::surface_of_cells({{0, 0, 0}, {1, 1, 0}})}) {
    for (const OutputFaces faces : {OutputFaces::quads, OutputFaces::triangles}) {
      RemeshOptions options;
      options.faces = faces;
      for (const RemeshResult& level :
           remesh_levels(input, std::array<std::size_t, 2>{300, 3000}, options)) {
        const MeshStatistics after = mesh_statistics(level.mesh);
        EXPECT_EQ(after.boundary_loops, mesh_statistics(input).boundary_loops);
        EXPECT_GE(after.non_manifold_edges, 3u);
        EXPECT_TRUE(find_crossings(level.mesh, Context()).empty());
      }
    }
  }
}

/// The pieces that `--manifold` leaves apart are whole; hexagons always leave them apart.
TEST(Topology, CubesThatAreLeftApartAreClosed) {
  const Mesh cubes = made::surface_of_cells({{0, 0, 0}, {1, 1, 0}});
  for (const OutputFaces faces : {OutputFaces::quads, OutputFaces::hexagons}) {
    RemeshOptions options;
    options.face_count = 1000;
    options.faces = faces;
    options.manifold = faces == OutputFaces::quads;
    const MeshStatistics after = mesh_statistics(remesh(cubes, options).mesh);
    EXPECT_EQ(after.components, 2u);
    EXPECT_EQ(after.euler, 4);
    EXPECT_EQ(after.boundary_loops, 0u);
    EXPECT_EQ(after.non_manifold_edges, 0u);
  }
}

/// A comb, whose teeth are hardly wider than what hexagons leave out along the border.
TEST(Topology, HexagonsSayWhereTheyFallApart) {
  Mesh comb = made::grid(17, 6, false, false, [](double u, double v) {
    return Vec3(static_cast<float>(17 * u), static_cast<float>(6 * v), 0);
  });
  Faces kept;
  for (std::size_t f = 0; f < comb.faces.size(); ++f) {
    const auto face = std::as_const(comb.faces)[f];
    Vec3 middle = Vec3::Zero();
    for (const Index v : face) middle += comb.positions[v] / static_cast<float>(face.size());
    if (middle.y() < 1 || static_cast<int>(middle.x()) % 2 == 0) kept.push_back(face);
  }
  comb.faces = std::move(kept);
  RemeshOptions options;
  options.faces = OutputFaces::hexagons;
  options.face_count = 60;
  const RemeshResult result = remesh(comb, options);
  EXPECT_GT(mesh_statistics(result.mesh).components, 1u);
  EXPECT_TRUE(made::has_note(result, "1 piece fell into "));
}

/// Holes and pieces that are nothing but faults take few faces from the rest.
TEST(Topology, ManyTinyHolesAndPiecesLeaveTheShape) {
  const Mesh scan = faulty_scan(500);
  const MeshStatistics before = mesh_statistics(scan);
  ASSERT_GT(before.boundary_loops, 180u);
  RemeshOptions options;
  options.face_count = 2000;
  const RemeshResult result = remesh(scan, options);
  ASSERT_EQ(result.report.notes.size(), 1u);
  EXPECT_TRUE(result.report.notes[0].starts_with("93 pieces are smaller than a face"))
      << result.report.notes[0];
  const MeshStatistics after = mesh_statistics(result.mesh);
  made::expect_same_topology(after, before);
  EXPECT_EQ(after.quads, after.faces);
  EXPECT_NEAR(static_cast<double>(after.faces), 2000, 20);
  EXPECT_EQ(after.inverted_quads, 0u);
  EXPECT_LT(after.area_sigma, 0.5);  // in a coarse lattice 0.81
  EXPECT_LT(after.angle_sigma, 23);
}

}  // namespace
}  // namespace meshgrain
