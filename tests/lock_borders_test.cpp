// Borders that stay: --lock-borders.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "measure/crossings.h"
#include "mesh/border.h"
#include "meshgrain/clean.h"
#include "meshgrain/error.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

/// The border as pairs of positions, in the direction of its faces: the same sets are the same
/// vertices and edges, bit for bit.
using Position = std::array<float, 3>;
std::multiset<std::array<Position, 2>> border_of(const Mesh& mesh) {
  const auto position = [&](Index v) {
    const Vec3& p = mesh.positions[v];
    return Position{p.x(), p.y(), p.z()};
  };
  std::multiset<std::array<Position, 2>> result;
  for (const auto& [a, b] : border_edges(mesh)) result.insert({position(a), position(b)});
  return result;
}

Mesh keep(Mesh mesh, const std::function<bool(const Vec3&)>& wanted) {
  Faces kept;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = std::as_const(mesh.faces)[f];
    Vec3 middle = Vec3::Zero();
    for (const Index v : face) middle += mesh.positions[v] / static_cast<float>(face.size());
    if (wanted(middle)) kept.push_back(face);
  }
  mesh.faces = std::move(kept);
  clean(mesh);
  return mesh;
}

/// The wall of a cylinder of radius 1, with so many edges around below and above.
Mesh tube(std::size_t below, std::size_t above, float height = 0.5f) {
  Mesh mesh;
  const auto add_ring = [&](std::size_t count, float z) {
    const auto first = static_cast<Index>(mesh.positions.size());
    for (std::size_t k = 0; k < count; ++k) {
      const double angle =
          2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
      mesh.positions.push_back(
          {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), z});
    }
    return first;
  };
  const Index low = add_ring(below, 0), high = add_ring(above, height);
  std::size_t i = 0, j = 0;
  while (i < below || j < above) {
    const auto a = static_cast<Index>(low + i % below), b = static_cast<Index>(high + j % above);
    if (i * above <= j * below) {
      mesh.faces.push_back({a, static_cast<Index>(low + ++i % below), b});
    } else {
      mesh.faces.push_back({a, static_cast<Index>(high + ++j % above), b});
    }
  }
  return mesh;
}

struct Case {
  std::string name;
  Mesh mesh;
  bool is_even;  ///< All loops have an even number of edges.
};

std::vector<Case> cases() {
  std::vector<Case> result;
  result.push_back({"plate", sample_shape("plate", 0.5), true});
  result.push_back({"odd tube", tube(47, 61), false});
  result.push_back({"fine above", tube(30, 150), true});
  Mesh pierced = keep(sample_shape("sphere"), [](const Vec3& p) {
    const auto far_from = [&](const Vec3& q, float radius) { return (p - q).norm() > radius; };
    return far_from({0, 0, 1}, 0.7f) && far_from({1, 0, 0}, 0.3f) && far_from({0, 1, 0}, 0.15f);
  });
  result.push_back({"pierced sphere", std::move(pierced), false});
  return result;
}

void expect_same_border(const Mesh& input, const Mesh& result) {
  EXPECT_EQ(border_of(result), border_of(input));
  made::expect_same_topology(mesh_statistics(result), mesh_statistics(input));
}

Mesh locked(const Mesh& mesh, OutputFaces faces, std::size_t count) {
  RemeshOptions options;
  options.faces = faces;
  options.face_count = count;
  options.lock_borders = true;
  return remesh(mesh, options).mesh;
}

TEST(LockBorders, TheBorderIsTheInputsBitForBit) {
  for (const Case& shape : cases()) {
    for (const OutputFaces faces :
         {OutputFaces::quads, OutputFaces::quad_dominant, OutputFaces::triangles}) {
      const std::size_t many = faces == OutputFaces::quads ? 3000 : 1000;
      for (const std::size_t count : {std::size_t{500}, many}) {
        SCOPED_TRACE(shape.name + " " + std::to_string(static_cast<int>(faces)) + " " +
                     std::to_string(count));
        const Mesh result = locked(shape.mesh, faces, count);
        expect_same_border(shape.mesh, result);
        const MeshStatistics after = mesh_statistics(result);
        EXPECT_EQ(after.inverted_quads, 0u);
        if (faces == OutputFaces::triangles) {
          EXPECT_EQ(after.triangles, after.faces);
        }
        if (faces == OutputFaces::quads && shape.is_even) {
          EXPECT_EQ(after.quads, after.faces);
        }
        // 180 vertices on borders leave no room for 500 faces, nor for 1000 triangles.
        if (count == 3000) {
          const auto wanted = static_cast<double>(count);
          EXPECT_NEAR(static_cast<double>(after.faces), wanted, 0.015 * wanted);
        }
      }
    }
  }
}

/// Borders far finer and far coarser than the faces, and the smallest that there are.
TEST(LockBorders, AnyNumberOfVerticesIsMet) {
  std::vector<Case> shapes;
  shapes.push_back({"fine", sample_shape("plate"), true});
  shapes.push_back({"coarse", sample_shape("plate", 0.2), true});
  shapes.push_back({"prism", tube(3, 3, 2), false});
  shapes.push_back({"four and five", tube(4, 5, 2), false});
  shapes.push_back({"a triangle", Mesh(), false});
  shapes.back().mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  shapes.back().mesh.faces.push_back({0, 1, 2});
  for (const Case& shape : shapes) {
    for (const OutputFaces faces :
         {OutputFaces::quads, OutputFaces::quad_dominant, OutputFaces::triangles}) {
      for (const std::size_t count : {20, 100}) {
        SCOPED_TRACE(shape.name + " " + std::to_string(static_cast<int>(faces)) + " " +
                     std::to_string(count));
        expect_same_border(shape.mesh, locked(shape.mesh, faces, count));
      }
    }
  }
}

/// Where rows meet the border's vertices two to one, both edges at a corner can be held with one
/// more on each side.
TEST(LockBorders, CornersOfSheetsHaveNoStraightAngle) {
  constexpr Index across = 60;
  for (const bool turned : {false, true}) {
    Mesh sheet;
    for (Index y = 0; y < across; ++y) {
      for (Index x = 0; x < across; ++x) {
        const Vec3 p(static_cast<float>(x), static_cast<float>(y), 0);
        sheet.positions.push_back(p + Vec3(0, 0, 3 * std::sin(p.x() / 9) * std::cos(p.y() / 9)));
      }
    }
    for (Index y = 0; y + 1 < across; ++y) {
      for (Index x = 0; x + 1 < across; ++x) {
        const Index a = y * across + x, b = a + 1, c = b + across, d = a + across;
        sheet.faces.push_back(turned ? std::array{a, b, d} : std::array{a, b, c});
        sheet.faces.push_back(turned ? std::array{b, c, d} : std::array{a, c, d});
      }
    }
    for (const std::size_t count : {300, 700, 1500}) {
      SCOPED_TRACE(count);
      const Mesh result = locked(sheet, OutputFaces::quads, count);
      const MeshStatistics after = mesh_statistics(result);
      EXPECT_EQ(after.inverted_quads, 0u);
      EXPECT_GT(after.jacobian_min, 0.3);
    }
  }
}

TEST(LockBorders, AnOddBorderTakesOneTriangle) {
  RemeshOptions options;
  options.face_count = 1000;
  options.lock_borders = true;
  const RemeshResult even = remesh(tube(40, 60), options);
  EXPECT_EQ(mesh_statistics(even.mesh).triangles, 0u);
  EXPECT_TRUE(even.report.notes.empty());
  const RemeshResult odd = remesh(tube(41, 60), options);
  EXPECT_EQ(mesh_statistics(odd.mesh).triangles, 1u);
  ASSERT_EQ(odd.report.notes.size(), 1u);
  EXPECT_NE(odd.report.notes[0].find("1 triangle:"), std::string::npos) << odd.report.notes[0];
}

/// Where three sheets meet in an edge, and two in a vertex, they still do.
/// An L of a single polygon, whose border has edges of up to 70 faces: those that meet them would
/// pass through each other.
TEST(LockBorders, EdgesFarLongerThanFacesAreDividedWhereTheyMustBe) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {1, 1, 0}, {1, 4, 0}, {0, 4, 0}};
  mesh.faces.push_back({0, 1, 2, 3, 4, 5});
  RemeshOptions options;
  options.face_count = 600;
  options.lock_borders = true;
  const RemeshResult result = remesh(mesh, options);
  const MeshStatistics after = mesh_statistics(result.mesh);
  made::expect_same_topology(after, mesh_statistics(mesh));
  EXPECT_EQ(after.inverted_quads, 0u);
  EXPECT_EQ(after.quads, after.faces);
  EXPECT_TRUE(find_crossings(result.mesh, Context()).empty());
  EXPECT_EQ(std::ranges::count_if(
                result.report.notes,
                [](const std::string& note) { return note.starts_with("divided edges"); }),
            1);
  // Corners are where they were, and what came between lies on the border.
  for (const Vec3& corner : mesh.positions) {
    EXPECT_NE(std::ranges::find(result.mesh.positions, corner), result.mesh.positions.end());
  }
  const auto lies_on = [](const Vec3& p, const Vec3& a, const Vec3& b) {
    return std::abs((p - a).norm() + (b - p).norm() - (b - a).norm()) < 1e-5f;
  };
  for (const auto& edge : border_edges(result.mesh)) {
    const Vec3& p = result.mesh.positions[edge[0]];
    bool any = false;
    for (std::size_t k = 0; k < 6; ++k) {
      any = any || lies_on(p, mesh.positions[k], mesh.positions[(k + 1) % 6]);
    }
    EXPECT_TRUE(any) << p.transpose();
  }
}

TEST(LockBorders, SheetsThatMeetGoOnToMeet) {
  Mesh mesh = sample_shape("plate", 0.3);
  const std::size_t count = mesh.positions.size();
  Mesh wall = mesh;
  float row = mesh.positions[0].y();  // not of the border
  for (const Vec3& p : mesh.positions) row = std::abs(p.y()) < std::abs(row) ? p.y() : row;
  for (Vec3& p : wall.positions) p = Vec3(p.x(), row, p.y() + 0.5f);
  std::vector<Index> place(count);
  for (Index v = 0; v < count; ++v) {
    const auto same =
        std::ranges::find_if(mesh.positions, [&](const Vec3& p) { return p == wall.positions[v]; });
    place[v] = static_cast<Index>(same - mesh.positions.begin());
    if (same == mesh.positions.end()) mesh.positions.push_back(wall.positions[v]);
  }
  for (std::size_t f = 0; f < wall.faces.size(); ++f) {
    const auto face = std::as_const(wall.faces)[f];
    mesh.faces.push_back({place[face[0]], place[face[1]], place[face[2]]});
  }
  ASSERT_GT(mesh_statistics(mesh).non_manifold_edges, 0u);
  for (const OutputFaces faces : {OutputFaces::quads, OutputFaces::triangles}) {
    RemeshOptions options;
    options.faces = faces;
    options.face_count = 600;
    options.lock_borders = true;
    const Mesh result = remesh(mesh, options).mesh;
    EXPECT_EQ(border_of(result), border_of(mesh));
    EXPECT_EQ(mesh_statistics(result).non_manifold_edges, mesh_statistics(mesh).non_manifold_edges);
  }
}

/// Creases run into the border, which stays as noisy as it is.
TEST(LockBorders, NoiseIsTakenOutBesideTheBorderOnly) {
  Mesh scan = sample_shape("bracket", 2);
  add_noise(scan, 0.2);
  scan = keep(std::move(scan), [](const Vec3& p) { return p.x() > 0; });
  RemeshOptions options;
  options.face_count = 3000;
  options.lock_borders = true;
  const RemeshResult result = remesh(scan, options);
  expect_same_border(scan, result.mesh);
  const auto tells_of_noise = [](const std::string& note) {
    return note.find("noisy") != std::string::npos;
  };
  EXPECT_TRUE(std::ranges::any_of(result.report.notes, tells_of_noise));
}

TEST(LockBorders, StaysUnderOtherOptions) {
  const Mesh input = tube(40, 60);
  RemeshOptions options;
  options.lock_borders = true;
  options.sizing.adaptive = 1;
  options.smoothing = 0;
  const std::vector<std::size_t> counts{2000, 500};
  for (const RemeshResult& level : remesh_levels(input, counts, options)) {
    expect_same_border(input, level.mesh);
  }
  options.edge_length = 0.1;
  options.features.align_border = false;
  expect_same_border(input, remesh(input, options).mesh);
}

TEST(LockBorders, IsRefusedWhereThereIsNone) {
  RemeshOptions options;
  options.lock_borders = true;
  const Mesh plate = sample_shape("plate", 0.2);
  Mesh cloud = plate;
  cloud.faces.clear();
  EXPECT_THROW(remesh(cloud, options), Error);
  options.faces = OutputFaces::hexagons;
  EXPECT_THROW(remesh(plate, options), Error);
  options.faces = OutputFaces::quads;
  options.graph.nodes = GraphNodes::faces;
  EXPECT_THROW(remesh(plate, options), Error);
  options.graph.nodes = GraphNodes::vertices;
  options.symmetry.automatic = true;
  EXPECT_THROW(remesh(plate, options), Error);
}

}  // namespace
}  // namespace meshgrain
