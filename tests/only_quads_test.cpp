#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "extract/cheapest_pairs.h"
#include "extract/collect_faces.h"
#include "extract/extraction_map.h"
#include "extract/pair_odd_faces.h"
#include "features/lines_abreast.h"
#include "kept_creases.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

/// The cheapest pair of all leaves two that are far from each other.
TEST(CheapestPairs, PartnersChangeWhereThatCostsLess) {
  const std::vector<std::vector<Match>> matches{
      {{2, 1}, {10, 3}}, {{1, 2}, {2, 0}}, {{1, 1}, {2, 3}}, {{2, 2}, {10, 0}}};
  EXPECT_EQ(cheapest_pairs(matches), (std::vector<Index>{1, 0, 3, 2}));
}

TEST(CheapestPairs, SeveralMayGoWithNobody) {
  constexpr Index nobody = Match::nobody;
  const std::vector<std::vector<Match>> matches{
      {{1, nobody}, {5, 1}}, {{5, 0}, {1, nobody}}, {{3, nobody}}, {}};
  EXPECT_EQ(cheapest_pairs(matches), (std::vector<Index>{nobody, nobody, nobody, no_index}));
}

Extraction without_lines(Mesh mesh) {
  Extraction extraction;
  extraction.nodes.resize(mesh.positions.size());
  std::iota(extraction.nodes.begin(), extraction.nodes.end(), Index{0});
  if (mesh.normals.empty()) mesh.normals.assign(mesh.positions.size(), Vec3::UnitZ());
  extraction.mesh = std::move(mesh);
  return extraction;
}

Extraction paired(const Extraction& extraction) {
  ExtractionMap parts(extraction, Context());
  FaceRepair repair(parts.map, parts.clusters, 4, std::move(parts.holes), std::move(parts.lines));
  pair_odd_faces(parts.map, repair, Context());
  std::vector<Index> vertex;
  return collect_faces(parts.map, repair, parts.clusters, vertex, Context());
}

void expect_quads(const Mesh& mesh) {
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) EXPECT_EQ(mesh.faces.degree(f), 4u);
}

/// Triangles alone, and few of them among quads; closed or open, with handles.
TEST(PairOddFaces, LeavesQuadsOfTheSameTopology) {
  for (const char* name : {"sphere", "three-holes", "torus", "plate", "bracket", "blob"}) {
    SCOPED_TRACE(name);
    const Mesh triangles = sample_shape(name);
    RemeshOptions options;
    options.faces = OutputFaces::quad_dominant;
    options.face_count = 700;
    const Mesh mostly_quads = remesh(triangles, options).mesh;
    for (const Mesh* mesh : {&triangles, &mostly_quads}) {
      const Extraction result = paired(without_lines(*mesh));
      expect_quads(result.mesh);
      made::expect_same_topology(mesh_statistics(result.mesh), mesh_statistics(*mesh));
    }
    // No more than a row for each pair.
    EXPECT_LT(paired(without_lines(mostly_quads)).mesh.faces.size(),
              mostly_quads.faces.size() * 3 / 2);
  }
}

/// Two triangles at the ends of a row of quads: the row is cut along its middle.
TEST(PairOddFaces, ARowBetweenTwoTrianglesIsCutInTwo) {
  Mesh mesh;
  constexpr Index quads = 4;
  for (Index k = 0; k <= quads; ++k) {
    mesh.positions.push_back({static_cast<float>(k), 0, 0});
    mesh.positions.push_back({static_cast<float>(k), 1, 0});
  }
  mesh.positions.push_back({-1, 0.5f, 0});
  mesh.positions.push_back({quads + 1, 0.5f, 0});
  for (Index k = 0; k < quads; ++k) mesh.faces.push_back({2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1});
  mesh.faces.push_back({2 * quads + 2, 0, 1});
  mesh.faces.push_back({2 * quads, 2 * quads + 3, 2 * quads + 1});
  const Mesh result = paired(without_lines(mesh)).mesh;
  expect_quads(result);
  EXPECT_EQ(result.faces.size(), 2 * quads + 2);
  EXPECT_EQ(result.positions.size(), mesh.positions.size() + quads + 1);
}

/// The two rims of a thin plate, which its short edges join.
TEST(LinesAbreast, AreTheRimsOfAThinPlate) {
  Mesh plate = sample_shape("cube");
  for (Vec3& p : plate.positions) p.z() *= 0.1f;
  const FeatureLines lines = find_features(plate, {}, 0.05);
  std::vector<std::uint8_t> on_border(plate.positions.size(), 0);
  EXPECT_NEAR(share_abreast(lines, on_border, 0.12), 8 / 8.4, 0.03);
  EXPECT_EQ(share_abreast(lines, on_border, 0.08), 0);
  EXPECT_EQ(share_abreast({}, on_border, 0.12), 0);
  on_border.assign(on_border.size(), 1);
  EXPECT_EQ(share_abreast(lines, on_border, 0.12), 0);
}

/// The steps of the shaft are hardly wider than a face.
TEST(OnlyQuads, LinesAFaceApartAreKept) {
  const Mesh input = sample_shape("shaft", 2);
  for (const std::size_t count : {450, 500, 550}) {
    SCOPED_TRACE(count);
    RemeshOptions options;
    options.face_count = count;
    const Mesh output = remesh(input, options).mesh;
    expect_quads(output);
    EXPECT_NEAR(static_cast<double>(output.faces.size()), static_cast<double>(count),
                0.01 * static_cast<double>(count));
    const MeshStatistics statistics = mesh_statistics(output);
    made::expect_same_topology(statistics, mesh_statistics(input));
    EXPECT_EQ(statistics.inverted_quads, 0u);
    EXPECT_GT(made::kept_creases(input, output).creases, 0.97);
  }
}

/// A closed tube: `position(a, b)` at angles along it and around it.
template <typename Position>
Mesh closed_tube(Index along, Index around, const Position& position) {
  Mesh mesh;
  for (Index k = 0; k < along * around; ++k) {
    const Eigen::Vector3d p = position(2 * std::numbers::pi * (k / around) / along,
                                       2 * std::numbers::pi * (k % around) / around);
    mesh.positions.push_back(p.cast<float>());
    const Index next = k % around + 1 < around ? k + 1 : k + 1 - around;
    const auto beyond = [&](Index v) { return (v + around) % (along * around); };
    mesh.faces.push_back(std::array<Index, 3>{k, beyond(k), beyond(next)});
    mesh.faces.push_back(std::array<Index, 3>{k, beyond(next), next});
  }
  return mesh;
}

/// A torus of radius 1 around the z axis.
Mesh ring(double radius) {
  return closed_tube(200, 24, [&](double a, double b) {
    const double from_axis = 1 + radius * std::cos(b);
    return Eigen::Vector3d(from_axis * std::cos(a), from_axis * std::sin(a), radius * std::sin(b));
  });
}

/// Of what comes of a closed tube with so many faces: quads alone, and of the same topology.
MeshStatistics statistics_of_quads(const Mesh& input, const RemeshOptions& options) {
  const Mesh output = remesh(input, options).mesh;
  expect_quads(output);
  const MeshStatistics statistics = mesh_statistics(output);
  made::expect_same_topology(statistics, mesh_statistics(input));
  return statistics;
}

/// Of three to eight quads around. A coarser lattice often leaves inverted ones.
TEST(OnlyQuads, ThinRingsAreEven) {
  constexpr double radii[] = {0.1, 0.12, 0.15};
  constexpr std::size_t counts[] = {150, 200, 300};
  double sigma = 0, jacobian = 0;
  for (const double radius : radii) {
    const Mesh input = ring(radius);
    for (const std::size_t count : counts) {
      SCOPED_TRACE(std::to_string(radius) + " " + std::to_string(count));
      RemeshOptions options;
      options.face_count = count;
      const MeshStatistics statistics = statistics_of_quads(input, options);
      EXPECT_EQ(statistics.inverted_quads, 0u);
      sigma += statistics.area_sigma / (std::size(radii) * std::size(counts));
      jacobian += statistics.jacobian_p01 / (std::size(radii) * std::size(counts));
    }
  }
  EXPECT_LT(sigma, 0.25);
  EXPECT_GT(jacobian, 0.65);
}

/// No limb of a half is a single quad wide, whose sides would both be in the plane.
TEST(OnlyQuads, ThinRingsCanBeMirrored) {
  for (const double radius : {0.08, 0.1, 0.12}) {
    const Mesh input = ring(radius);
    for (const std::size_t count : {120, 150, 200, 300}) {
      for (const bool both : {false, true}) {
        SCOPED_TRACE(std::to_string(radius) + " " + std::to_string(count));
        RemeshOptions options;
        options.face_count = count;
        options.symmetry.axes = {both, false, true};
        statistics_of_quads(input, options);
      }
    }
  }
}

/// A wire in the shape of a trefoil knot.
Mesh knotted_wire(double radius) {
  return closed_tube(400, 16, [&](double a, double b) {
    const Eigen::Vector3d p(std::sin(a) + 2 * std::sin(2 * a), std::cos(a) - 2 * std::cos(2 * a),
                            -std::sin(3 * a));
    const Eigen::Vector3d ahead(std::cos(a) + 4 * std::cos(2 * a),
                                -std::sin(a) + 4 * std::sin(2 * a), -3 * std::cos(3 * a));
    const Eigen::Vector3d side = ahead.cross(Eigen::Vector3d::UnitZ()).normalized();
    const Eigen::Vector3d up = side.cross(ahead).normalized();
    return Eigen::Vector3d(p + radius * (std::cos(b) * up + std::sin(b) * side));
  });
}

/// With two cells of the coarse lattice around, no row can go straight.
TEST(OnlyQuads, RowsGoStraightAlongWires) {
  const Mesh input = knotted_wire(0.06);
  for (const std::size_t count : {900, 1000, 1100, 1200, 1300}) {
    SCOPED_TRACE(count);
    RemeshOptions options;
    options.face_count = count;
    const MeshStatistics statistics = statistics_of_quads(input, options);
    EXPECT_LE(statistics.singularities, 30u);
    EXPECT_GT(statistics.jacobian_p01, 0.7);
  }
}

}  // namespace
}  // namespace meshgrain
