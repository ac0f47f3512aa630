#include "meshgrain/extract.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <ranges>
#include <utility>

#include "extract/add_strips.h"
#include "extract/collect_faces.h"
#include "extract/drop_unused.h"
#include "extract/extraction_map.h"
#include "extract/face_repair.h"
#include "extract/piece.h"
#include "extract/remove_strips.h"
#include "made_fields.h"
#include "made_points.h"
#include "mesh/border.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/finish.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

constexpr double pi = std::numbers::pi;

/// With the border held, a square plate comes back as its grid: all quads, all interior vertices
/// regular, the exact count, and the corners where they were.
TEST(Extract, APlateComesBackAsItsGrid) {
  for (const int cells : {7, 10, 16}) {
    SCOPED_TRACE(cells);
    RemeshOptions options;
    options.faces = OutputFaces::quad_dominant;
    options.edge_length = 1.0 / cells;
    options.features.align_border = true;
    const Mesh mesh = remesh(sample_shape("plate"), options).mesh;
    const MeshStatistics s = mesh_statistics(mesh);
    const auto n = static_cast<std::size_t>(cells);
    EXPECT_EQ(s.quads, n * n);
    EXPECT_EQ(s.faces, s.quads);
    EXPECT_EQ(s.vertices, (n + 1) * (n + 1));
    EXPECT_EQ(s.irregular_vertices, 0u);
    EXPECT_EQ(s.boundary_loops, 1u);
    EXPECT_EQ(s.euler, 1);
    EXPECT_NEAR(surface_area(mesh), 1, 1e-3);
    EXPECT_LT(s.area_sigma, 0.02);
    for (const float x : {-0.5f, 0.5f}) {
      for (const float y : {-0.5f, 0.5f}) {
        float nearest = 1;
        for (const Vec3& p : mesh.positions)
          nearest = std::min(nearest, (p - Vec3(x, y, 0)).norm());
        EXPECT_LT(nearest, 1e-3f);
      }
    }
  }
}

TEST(Extract, PureQuadsOfAPlateAreItsGridToo) {
  RemeshOptions options;
  options.edge_length = 0.05;
  options.features.align_border = true;
  const MeshStatistics s = mesh_statistics(remesh(sample_shape("plate"), options).mesh);
  EXPECT_EQ(s.quads, 400u);
  EXPECT_EQ(s.faces, 400u);
  EXPECT_EQ(s.irregular_vertices, 0u);
}

/// Where the lattice misses the count, rows and columns are taken out until it is met.
TEST(Extract, APlateOfAnotherCountIsAGridToo) {
  for (const std::size_t count : {2100, 5000, 7777}) {
    SCOPED_TRACE(count);
    RemeshOptions options;
    options.face_count = count;
    const MeshStatistics s = mesh_statistics(remesh(sample_shape("plate"), options).mesh);
    const auto wanted = static_cast<double>(count);
    EXPECT_NEAR(static_cast<double>(s.faces), wanted, 0.01 * wanted);
    EXPECT_EQ(s.irregular_vertices, 0u);
    EXPECT_EQ(s.euler, 1);
    EXPECT_EQ(s.boundary_loops, 1u);
    EXPECT_LT(s.area_sigma, 0.05);
  }
}

/// A surface with a parametrization of whole cells along both axes.
struct Parametrized {
  Mesh mesh;
  std::function<made::Coordinates(const Vec3&)> coordinates;
  std::size_t cells_a, cells_b;
  bool wrap_a, wrap_b;
  float edge_length;
};

/// `nodes` a cell along either axis. For S = 6 rows are closer by sqrt(3) / 2, and each is half an
/// edge further along.
double row_height(int symmetry) {
  return symmetry == 4 ? 1 : std::sqrt(0.75);
}
made::Coordinates lattice_coordinates(int symmetry, double along, double across, const Vec3& u) {
  if (symmetry == 4) return {along, across, u};
  const double b = across / std::sqrt(0.75);
  return {along - b / 2, b, u};
}

Parametrized plane(int symmetry) {
  const std::size_t a = 12, b = 9;
  const Vec3 u = Vec3(0.8f, 0.6f, 0), w(-0.6f, 0.8f, 0);
  const double rho = 0.1, height = row_height(symmetry), shear = symmetry == 4 ? 0 : 0.5;
  return {made::grid(a * 5, b * 5, false, false,
                     [=](double x, double y) -> Vec3 {
                       const double q = y * static_cast<double>(b);
                       const double p = x * static_cast<double>(a) + shear * q;
                       return static_cast<float>(rho * p) * u +
                              static_cast<float>(rho * height * q) * w;
                     }),
          [=](const Vec3& p) { return lattice_coordinates(symmetry, p.dot(u), p.dot(w), u); },
          a,
          b,
          false,
          false,
          static_cast<float>(rho)};
}

Parametrized tube(int symmetry) {
  const std::size_t a = 24, b = 8;
  const double rho = 2 * pi / static_cast<double>(a), height = rho * row_height(symmetry);
  return {made::grid(a * 5, b * 5, true, false,
                     [=](double x, double y) -> Vec3 {
                       return Eigen::Vector3d(std::cos(2 * pi * x), std::sin(2 * pi * x),
                                              y * height * static_cast<double>(b))
                           .cast<float>();
                     }),
          [=](const Vec3& p) {
            return lattice_coordinates(symmetry, std::atan2(p.y(), p.x()), p.z(),
                                       Vec3(-p.y(), p.x(), 0).normalized());
          },
          a,
          b,
          true,
          false,
          static_cast<float>(rho)};
}

/// So slender that cells inside and outside are of nearly one size.
Parametrized ring(int symmetry) {
  const std::size_t b = 10;
  const double major = 4, minor = 0.25;
  const double rho = 2 * pi * minor / (static_cast<double>(b) * row_height(symmetry));
  const double cells = std::round(2 * pi * major / rho);
  return {made::grid(static_cast<std::size_t>(cells) * 4, b * 5, true, true,
                     [=](double x, double y) -> Vec3 {
                       const double r = major + minor * std::cos(2 * pi * y);
                       return Eigen::Vector3d(r * std::cos(2 * pi * x), r * std::sin(2 * pi * x),
                                              minor * std::sin(2 * pi * y))
                           .cast<float>();
                     }),
          [=](const Vec3& p) {
            const double angle = std::atan2(p.y(), p.x());
            const double across = std::atan2(p.z(), std::hypot(p.x(), p.y()) - major);
            return lattice_coordinates(symmetry, angle / (2 * pi) * cells * rho, across * minor,
                                       Vec3(-p.y(), p.x(), 0).normalized());
          },
          static_cast<std::size_t>(cells),
          b,
          true,
          true,
          static_cast<float>(rho)};
}

TEST(Extract, AFieldFromAParametrizationGivesItsGrid) {
  for (const int symmetry : {4, 6}) {
    for (const auto& [name, surface] : {std::pair{"plane", plane(symmetry)},
                                        {"tube", tube(symmetry)},
                                        {"ring", ring(symmetry)}}) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(symmetry));
      const Graph graph = build_graph(surface.mesh);
      const auto fields =
          made::sample_fields(graph, symmetry, surface.edge_length, surface.coordinates);
      for (const PositionEnergy energy : {PositionEnergy::extrinsic, PositionEnergy::intrinsic}) {
        ExtractOptions options;
        options.energy = energy;
        options.border = border_edges(surface.mesh);
        const Extraction extraction =
            extract_mesh(graph, fields.orientation, fields.position, options);
        const MeshStatistics s = mesh_statistics(extraction.mesh);
        const std::size_t cells = surface.cells_a * surface.cells_b;
        EXPECT_EQ(s.faces, symmetry == 4 ? cells : 2 * cells);
        EXPECT_EQ(symmetry == 4 ? s.quads : s.triangles, s.faces);
        EXPECT_EQ(s.vertices,
                  (surface.cells_a + !surface.wrap_a) * (surface.cells_b + !surface.wrap_b));
        EXPECT_EQ(s.irregular_vertices, 0u);
        EXPECT_EQ(s.isolated_vertices, 0u);
        // Vertices are lattice points: neighbours are an edge length apart.
        EXPECT_NEAR(s.edge_mean, surface.edge_length, 0.03 * surface.edge_length);
        ASSERT_EQ(extraction.nodes.size(), s.vertices);
        for (std::size_t v = 0; v < s.vertices; ++v) {
          EXPECT_LT((graph.positions[extraction.nodes[v]] - extraction.mesh.positions[v]).norm(),
                    0.5f * surface.edge_length);
        }
      }
    }
  }
}

Extraction made_extraction(std::vector<Vec3> positions, std::vector<std::vector<Index>> faces) {
  Extraction extraction;
  extraction.mesh.positions = std::move(positions);
  extraction.nodes.resize(extraction.mesh.positions.size());
  for (Index v = 0; v < extraction.nodes.size(); ++v) extraction.nodes[v] = v;
  for (const auto& face : faces) extraction.mesh.faces.push_back(face);
  return extraction;
}

TEST(SplitIntoQuads, MakesOneQuadACorner) {
  Extraction e = made_extraction({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {3, 1, 0}},
                                 {{0, 1, 2, 3}, {1, 4, 2}});
  const double area = surface_area(e.mesh);
  split_into_quads(e);
  const MeshStatistics s = mesh_statistics(e.mesh);
  EXPECT_EQ(s.faces, 7u);
  EXPECT_EQ(s.quads, 7u);
  EXPECT_EQ(s.vertices, 5u + 6u + 2u);
  EXPECT_EQ(s.euler, 1);
  EXPECT_EQ(s.boundary_loops, 1u);
  EXPECT_NEAR(surface_area(e.mesh), area, 1e-5);
  EXPECT_EQ(e.nodes.size(), e.mesh.positions.size());
}

TEST(TakeDual, MakesHexagonsOfRegularTriangles) {
  const Parametrized surface = ring(6);
  const Graph graph = build_graph(surface.mesh);
  const auto fields = made::sample_fields(graph, 6, surface.edge_length, surface.coordinates);
  Extraction e = extract_mesh(graph, fields.orientation, fields.position);
  const std::size_t vertices = e.mesh.positions.size(), faces = e.mesh.faces.size();
  take_dual(e);
  EXPECT_EQ(e.mesh.faces.size(), vertices);
  EXPECT_EQ(e.mesh.positions.size(), faces);
  EXPECT_EQ(e.mesh.faces.uniform_degree(), 6u);
  EXPECT_EQ(mesh_statistics(e.mesh).euler, 0);
  EXPECT_EQ(e.nodes.size(), e.mesh.positions.size());
}

TEST(TakeDual, LeavesTheBorderOut) {
  // A wheel of six triangles: one hexagon, whose corners are their centres.
  std::vector<Vec3> positions{Vec3::Zero()};
  std::vector<std::vector<Index>> faces;
  for (Index k = 0; k < 6; ++k) {
    const float angle = static_cast<float>(k) * 3.14159265f / 3;
    positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    faces.push_back({0, k + 1, (k + 1) % 6 + 1});
  }
  Extraction e = made_extraction(positions, faces);
  take_dual(e);
  ASSERT_EQ(e.mesh.faces.size(), 1u);
  EXPECT_EQ(e.mesh.faces[0].size(), 6u);
  EXPECT_EQ(e.mesh.positions.size(), 6u);
  // Turning the same way as the triangles did.
  const auto face = e.mesh.faces[0];
  EXPECT_GT(e.mesh.positions[face[0]].cross(e.mesh.positions[face[1]]).z(), 0);
}

TEST(MakeManifold, LeavesManifoldMeshesAlone) {
  Mesh mesh = sample_shape("bracket", 0.3);
  Extraction e{mesh, std::vector<Index>(mesh.positions.size(), 0), {}, {}};
  EXPECT_EQ(make_manifold(e), 0u);
  EXPECT_EQ(e.mesh.positions, mesh.positions);
  EXPECT_TRUE(std::ranges::equal(e.mesh.faces.corners(), mesh.faces.corners()));
}

TEST(MakeManifold, DropsTheThirdFaceOfAnEdge) {
  Extraction e = made_extraction({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                                 {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  EXPECT_EQ(make_manifold(e), 1u);
  const MeshStatistics s = mesh_statistics(e.mesh);
  EXPECT_EQ(s.faces, 2u);
  EXPECT_EQ(s.vertices, 4u);  // that of the dropped face went with it
  EXPECT_EQ(s.non_manifold_edges + s.non_manifold_vertices + s.isolated_vertices, 0u);
}

TEST(MakeManifold, SplitsAVertexBetweenFans) {
  Extraction e = made_extraction({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
                                 {{0, 1, 2}, {0, 3, 4}});
  EXPECT_EQ(mesh_statistics(e.mesh).non_manifold_vertices, 1u);
  EXPECT_EQ(make_manifold(e), 0u);
  const MeshStatistics s = mesh_statistics(e.mesh);
  EXPECT_EQ(s.vertices, 6u);
  EXPECT_EQ(s.non_manifold_vertices, 0u);
  EXPECT_EQ(s.components, 2u);
  EXPECT_EQ(e.nodes.size(), 6u);
}

TEST(MakeManifold, LinesAndCornersFollowTheCopies) {
  Extraction e = made_extraction(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}, {2, 0, 1}, {2, 1, 1}},
      {{0, 1, 2}, {0, 3, 4}, {1, 2, 5}, {1, 2, 6}});
  e.line_edges = {{0, 1, 0}, {3, 0, 1}, {1, 2, 2}, {1, 5, 3}, {2, 6, 4}};
  e.corners = {0};
  EXPECT_EQ(make_manifold(e), 2u);  // the second and the third on the edge from 1 to 2
  const auto at = [&](const Vec3& p) {
    std::vector<Index> found;
    for (Index v = 0; v < e.mesh.positions.size(); ++v) {
      if (e.mesh.positions[v] == p) found.push_back(v);
    }
    return found;
  };
  EXPECT_EQ(e.corners, at({0, 0, 0}));
  EXPECT_EQ(e.corners.size(), 2u);
  ASSERT_EQ(e.line_edges.size(), 3u) << "those of the faces that were dropped went with them";
  for (const auto& [a, b, line] : e.line_edges) {
    const bool is_edge = std::ranges::any_of(std::views::iota(std::size_t{0}, e.mesh.faces.size()),
                                             [&](std::size_t f) {
                                               const auto face = std::as_const(e.mesh.faces)[f];
                                               return std::ranges::find(face, a) != face.end() &&
                                                      std::ranges::find(face, b) != face.end();
                                             });
    EXPECT_TRUE(is_edge) << line;
  }
  EXPECT_EQ(e.line_edges[1].a, at({-1, 0, 0})[0]) << "ahead as before";
}

TEST(SplitIntoQuads, LeavesOutLinesThatNoFaceHas) {
  Extraction e = made_extraction({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}}, {{0, 1, 2}});
  e.line_edges = {{0, 1, 0}, {0, 3, 1}, {2, 3, 2}};
  split_into_quads(e);
  ASSERT_EQ(e.line_edges.size(), 2u);
  for (const LineEdge& edge : e.line_edges) EXPECT_EQ(edge.line, 0u);
}

/// Quads with a border that is a line, and a corner on it.
Extraction quads_with_a_border() {
  RemeshOptions options;
  options.face_count = 300;
  Extraction result;
  result.mesh = remesh(sample_shape("plate"), options).mesh;
  result.nodes.assign(result.mesh.positions.size(), 0);
  result.mesh.normals.assign(result.mesh.positions.size(), Vec3::UnitZ());
  for (const auto& [a, b] : rim_edges(result.mesh)) result.line_edges.push_back({a, b, 7});
  result.corners = {result.line_edges.front().a};
  return result;
}

TEST(Piece, IsPutBackAsItWas) {
  const Extraction whole = quads_with_a_border();
  const VertexFaces around = vertex_faces(whole.mesh);
  const MeshStatistics before = mesh_statistics(whole.mesh);
  for (Index f = 0; f < whole.mesh.faces.size(); f += 7) {
    const Piece piece = cut_piece(whole, around, f, 2);
    EXPECT_EQ(piece.faces.front(), f);
    EXPECT_EQ(piece.extraction.mesh.faces.size(), piece.faces.size());
    std::vector<Index> sources(piece.vertices.size(), no_index);
    for (Index v = 0; v < sources.size(); ++v) {
      if (piece.on_rim[v]) sources[v] = v;
    }
    Extraction again = put_back(whole, piece, piece.extraction, sources);
    drop_unused(again);
    const MeshStatistics after = mesh_statistics(again.mesh);
    EXPECT_EQ(after.vertices, before.vertices);
    EXPECT_EQ(after.faces, before.faces);
    EXPECT_EQ(after.euler, before.euler);
    EXPECT_EQ(after.boundary_loops, 1u);
    EXPECT_EQ(after.non_manifold_edges + after.non_manifold_vertices, 0u);
    EXPECT_NEAR(surface_area(again.mesh), surface_area(whole.mesh), 1e-5);
    EXPECT_EQ(again.line_edges.size(), whole.line_edges.size());
    ASSERT_EQ(again.corners.size(), 1u);
    const Vec3& corner = whole.mesh.positions[whole.corners[0]];
    EXPECT_EQ(again.mesh.positions[again.corners[0]], corner);
  }
}

/// Makes every change that `change(repair, face, way)` knows for a mesh of quads, each to the mesh
/// as it was, and expects the same topology, borders and lines, and more changes than faces.
/// `check_faces(after, before)` gets the numbers of faces.
template <typename Change, typename CheckFaces>
void expect_sound_changes(const Change& change, const CheckFaces& check_faces) {
  const Extraction whole = quads_with_a_border();
  const MeshStatistics before = mesh_statistics(whole.mesh);
  std::size_t count = 0;
  for (Index h = 0;; ++h) {
    for (std::size_t way = 0;; ++way) {
      ExtractionMap parts(whole, Context());
      if (h == parts.map.halfedges()) {
        EXPECT_GT(count, whole.mesh.faces.size());
        return;
      }
      if (parts.holes[h] || parts.corners[h] % 4 != 0) break;  // each face once
      FaceRepair repair(parts.map, parts.clusters, 4, parts.holes, parts.lines);
      if (!change(repair, h, way)) break;
      std::vector<Index> vertex;
      const Extraction after = collect_faces(parts.map, repair, parts.clusters, vertex, Context());
      const MeshStatistics s = mesh_statistics(after.mesh);
      check_faces(s.faces, before.faces);
      EXPECT_EQ(s.quads, s.faces);
      EXPECT_EQ(s.euler, before.euler);
      EXPECT_EQ(s.boundary_loops, before.boundary_loops);
      EXPECT_EQ(s.non_manifold_edges + s.non_manifold_vertices, 0u);
      EXPECT_EQ(after.line_edges.size(), whole.line_edges.size());
      EXPECT_EQ(after.corners.size(), 1u);
      ++count;
    }
  }
}

TEST(FaceRepair, QuadsCloseWithoutAChangeOfTopologyOrBorder) {
  const auto close = [](FaceRepair& repair, Index face, std::size_t way) {
    const std::vector<Index> ways = repair.ways_to_close(face);
    if (way >= ways.size()) return false;
    repair.close_quad(ways[way]);
    repair.remove_doublets();
    return true;
  };
  expect_sound_changes(close,
                       [](std::size_t after, std::size_t before) { EXPECT_LT(after, before); });
}

TEST(FaceRepair, EdgesTurnWithoutAChangeOfTopologyOrBorder) {
  const auto turn = [](FaceRepair& repair, Index face, std::size_t way) {
    const auto ways = repair.ways_to_turn(face);
    if (way >= ways.size()) return false;
    for (std::array<Index, 4> quad : repair.turned(ways[way])) {
      std::ranges::sort(quad);
      EXPECT_EQ(std::ranges::adjacent_find(quad), quad.end());
    }
    repair.apply(ways[way]);
    return true;
  };
  expect_sound_changes(turn,
                       [](std::size_t after, std::size_t before) { EXPECT_EQ(after, before); });
}

/// n times n squares, without the one in the middle.
Extraction grid_with_a_hole(Index n) {
  Extraction extraction;
  for (Index y = 0; y <= n; ++y) {
    for (Index x = 0; x <= n; ++x) {
      extraction.mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y), 0});
    }
  }
  const auto at = [n](Index x, Index y) { return y * (n + 1) + x; };
  for (Index y = 0; y < n; ++y) {
    for (Index x = 0; x < n; ++x) {
      if (x == n / 2 && y == n / 2) continue;
      extraction.mesh.faces.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  extraction.nodes.resize(extraction.mesh.positions.size());
  std::iota(extraction.nodes.begin(), extraction.nodes.end(), Index{0});
  return extraction;
}

/// However many strips go that end at it.
TEST(RemoveStrips, AHoleOfAFewEdgesStaysOpen) {
  Extraction extraction = grid_with_a_hole(5);
  const MeshStatistics before = mesh_statistics(extraction.mesh);
  EXPECT_GT(remove_strips(extraction, 100, 100, Context()), 0u);
  made::expect_same_topology(mesh_statistics(extraction.mesh), before);
}

/// Of which several go, and come, at a time.
TEST(RemoveStrips, ManyRowsLeaveAGridAndManyMoreDoSo) {
  constexpr Index n = 121;
  Extraction extraction = grid_with_a_hole(n);
  const MeshStatistics before = mesh_statistics(extraction.mesh);
  const auto is_grid_of = [&](std::size_t faces) {
    const MeshStatistics s = mesh_statistics(extraction.mesh);
    made::expect_same_topology(s, before);
    EXPECT_EQ(s.faces, faces);
    EXPECT_EQ(s.irregular_vertices, before.irregular_vertices);
    EXPECT_EQ(s.inverted_quads, 0u);
    EXPECT_NEAR(surface_area(extraction.mesh), n * n - 1, 1e-2 * n * n);
  };
  const std::size_t gone = remove_strips(extraction, 60 * n, 61 * n, Context());
  EXPECT_GE(gone, 60u * n);
  EXPECT_LE(gone, 61u * n);
  is_grid_of(before.faces - gone);
  const std::size_t more = add_strips(extraction, 60 * n, 61 * n, Context());
  EXPECT_GE(more, 60u * n);
  EXPECT_LE(more, 61u * n);
  is_grid_of(before.faces - gone + more);
}

TEST(AddStrips, AGridStaysAGrid) {
  constexpr Index n = 7;
  Extraction extraction = grid_with_a_hole(n);
  for (Index x = 0; x < n; ++x) extraction.line_edges.push_back({x, x + 1, 0});  // a rim
  const MeshStatistics before = mesh_statistics(extraction.mesh);
  // Strips have 7 faces, those that end at the hole 3.
  EXPECT_EQ(add_strips(extraction, 4, 7, Context()), 7u);
  EXPECT_EQ(add_strips(extraction, 1, 2, Context()), 0u);
  EXPECT_EQ(extraction.mesh.faces.size(), n * n - 1 + 7);
  EXPECT_EQ(extraction.mesh.faces.uniform_degree(), 4u);
  EXPECT_EQ(extraction.nodes.size(), extraction.mesh.positions.size());
  const MeshStatistics after = mesh_statistics(extraction.mesh);
  made::expect_same_topology(after, before);
  EXPECT_EQ(after.irregular_vertices, before.irregular_vertices);
  EXPECT_EQ(after.inverted_quads, 0u);
  EXPECT_NEAR(surface_area(extraction.mesh), n * n - 1, 1e-3);
  // The rim is a chain still.
  double length = 0;
  for (const auto& [a, b, line] : extraction.line_edges) {
    length += (extraction.mesh.positions[a] - extraction.mesh.positions[b]).norm();
  }
  EXPECT_NEAR(length, n, 1e-4);
  EXPECT_GE(extraction.line_edges.size(), n);
}

/// A trapezohedron: two poles with eight quads each, and between them only vertices with three.
TEST(Extract, VerticesWithFarTooManyEdgesAreCutInTwo) {
  constexpr Index n = 8;
  Extraction shape;
  const auto ring = [](Index k, int row) {
    const double angle = pi * (2 * (k % n) + row) / n;
    return Vec3(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)),
                row == 0 ? 0.2f : -0.2f);
  };
  for (const int row : {0, 1}) {
    for (Index k = 0; k < n; ++k) shape.mesh.positions.push_back(ring(k, row));
  }
  shape.mesh.positions.insert(shape.mesh.positions.end(), {Vec3(0, 0, 1), Vec3(0, 0, -1)});
  for (const Vec3& p : shape.mesh.positions) shape.mesh.normals.push_back(p.normalized());
  shape.nodes.assign(2 * n + 2, 0);
  const Index north = 2 * n, south = north + 1;
  for (Index k = 0; k < n; ++k) {
    const Index next = (k + 1) % n;
    shape.mesh.faces.push_back(std::array<Index, 4>{north, k, n + k, next});
    shape.mesh.faces.push_back(std::array<Index, 4>{south, n + next, next, n + k});
  }
  const Context context(1);
  ExtractionMap parts(shape, context);
  FaceRepair repair(parts.map, parts.clusters, 4, std::move(parts.holes), std::move(parts.lines));
  repair.open_vertices();
  std::vector<Index> vertex;
  const Mesh result = collect_faces(parts.map, repair, parts.clusters, vertex, Context()).mesh;
  const MeshStatistics after = mesh_statistics(result);
  EXPECT_EQ(after.faces, std::size_t{2 * n + 2});
  EXPECT_EQ(after.euler, 2);
  // Of 18: each pole is one with six and a regular one, and two of the others are regular.
  EXPECT_EQ(after.irregular_vertices, 14u);
  std::vector<int> valence(result.positions.size(), 0);
  for (const Index v : result.faces.corners()) ++valence[v];
  EXPECT_EQ(*std::ranges::max_element(valence), 6);
}

}  // namespace
}  // namespace meshgrain
