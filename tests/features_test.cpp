#include "meshgrain/features.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "features/cone_tips.h"
#include "features/fading_creases.h"
#include "features/mechanical_creases.h"
#include "has_note.h"
#include "kept_creases.h"
#include "made_cells.h"
#include "made_fields.h"
#include "made_graph.h"
#include "measure/crossings.h"
#include "measure/face_shape.h"
#include "mesh/border.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "meshgrain/triangulate.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

FeatureLines features_of(const Mesh& mesh, const FeatureOptions& options = {}) {
  return find_features(mesh, options, 3 * edge_lengths(mesh).mean);
}

TEST(Features, ACubeHasTwelveLinesAndEightCorners) {
  const FeatureLines lines = features_of(sample_shape("cube"));
  EXPECT_EQ(lines.size(), 12u);
  EXPECT_EQ(lines.corners.size(), 8u);
  for (std::size_t line = 0; line < lines.size(); ++line) EXPECT_FALSE(lines.is_closed(line));
}

TEST(Features, ACylinderHasTwoClosedLines) {
  const FeatureLines lines = features_of(sample_shape("cylinder"));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(lines.corners.empty());
  EXPECT_TRUE(lines.is_closed(0) && lines.is_closed(1));
}

TEST(Features, BordersAreLines) {
  const Mesh plate = sample_shape("plate");
  const FeatureLines lines = features_of(plate, {.align_border = false});
  EXPECT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines.corners.size(), 4u);
  for (const auto aligned : lines.align) EXPECT_EQ(aligned, 0);
  EXPECT_EQ(lines.vertices.size(), border_edges(plate).size() + 4);
}

TEST(Features, CreasesAreChosenByAngle) {
  const Mesh mesh = sample_shape("bracket");
  const std::size_t automatic = features_of(mesh).vertices.size();
  EXPECT_GT(automatic, 100u);
  EXPECT_EQ(features_of(mesh, {Creases::by_angle, 60}).vertices.size(), automatic);
  EXPECT_TRUE(features_of(mesh, {Creases::by_angle, 100}).empty());
  EXPECT_TRUE(features_of(mesh, {Creases::none}).empty());
}

/// Rounded shapes have none, and noise makes none.
TEST(Features, NothingIsFoundOnRoundShapes) {
  for (const char* name : {"sphere", "torus", "blob"}) {
    EXPECT_TRUE(features_of(sample_shape(name)).empty()) << name;
  }
  Mesh mesh = sample_shape("blob");
  const auto step = static_cast<float>(0.4 * edge_lengths(mesh).mean);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto x = static_cast<float>(v);
    mesh.positions[v] += step * Vec3(std::sin(12.9f * x), std::sin(78.2f * x), std::sin(37.7f * x));
  }
  EXPECT_TRUE(features_of(mesh).empty());
}

/// Of a sculpture with few large faces most edges may be sharp, but they are no creases; nor is it
/// the scan of a part.
TEST(Features, NothingIsFoundOnSculpturesOfFewFaces) {
  const Mesh smooth = sample_shape("torus", 0.25);
  const Mesh mesh = made::shaken(smooth, static_cast<float>(0.4 * edge_lengths(smooth).mean));
  const auto [clear, doubtful] = crease_lengths(mesh, sharp_edges(mesh, flat_degrees), Context(1));
  ASSERT_GT(clear, doubtful);
  EXPECT_TRUE(features_of(mesh).empty());
  RemeshOptions options;
  options.face_count = 1000;
  EXPECT_TRUE(remesh(mesh, options).report.notes.empty());
}

/// A long prism with so many sides, as a coarse cylinder.
Mesh prism(Index sides, float height) {
  Mesh mesh;
  for (Index i = 0; i < 2 * sides; ++i) {
    const float angle =
        2 * std::numbers::pi_v<float> * static_cast<float>(i / 2) / static_cast<float>(sides);
    mesh.positions.push_back({std::cos(angle), std::sin(angle), i % 2 == 0 ? 0 : height});
  }
  for (const float z : {0.0f, height}) mesh.positions.push_back({0, 0, z});
  for (Index i = 0; i < 2 * sides; i += 2) {
    const Index a = i, b = (i + 2) % (2 * sides), up = 2 * sides;
    mesh.faces.push_back({a, b, b + 1});
    mesh.faces.push_back({a, b + 1, a + 1});
    mesh.faces.push_back({b, a, up});
    mesh.faces.push_back({a + 1, b + 1, up + 1});
  }
  return mesh;
}

/// The edges between facets are longer than the creases by far, but these are clean lines.
TEST(Features, CreasesAreFoundAmongCoarseFacets) {
  Mesh mesh = prism(24, 20);
  for (const double longest : {100.0, 1.0, 0.2}) {
    subdivide(mesh, longest, Context(1));
    const FeatureLines lines = find_features(mesh, {}, 0.2);
    ASSERT_EQ(lines.size(), 2u) << longest;
    EXPECT_TRUE(lines.is_closed(0) && lines.is_closed(1));
    for (const Vec3& p : lines.positions) EXPECT_TRUE(p.z() == 0 || p.z() == 20);
  }
}

/// Of ten sides and more the facets count as round. They bend by up to 36 degrees, which is much
/// beside the right angles at its ends.
TEST(Features, CreasesOfCoarsePrismsAreFound) {
  for (const Index sides : {10, 11, 12, 13}) {
    for (const float height : {0.3f, 1.5f, 6.0f}) {
      SCOPED_TRACE(fmt::format("{} sides, {} high", sides, height));
      const FeatureLines lines = find_features(prism(sides, height), {}, 0.1);
      double length = 0;  // of what goes around, at the ends
      for (std::size_t line = 0; line < lines.size(); ++line) {
        for (Index k = lines.begin(line) + 1; k < lines.end(line); ++k) {
          const Vec3 along = lines.positions[k] - lines.positions[k - 1];
          if (along.z() == 0) length += along.norm();
        }
      }
      const double around = 2 * sides * std::sin(std::numbers::pi / sides);
      EXPECT_NEAR(length, 2 * around, 1e-3);
    }
  }
}

/// Two rods: the facets of one are so coarse that the creases at its ends are no clean lines.
Mesh rods() {
  Mesh mesh = prism(24, 20);
  const Mesh coarse = prism(10, 20);
  const auto first = static_cast<Index>(mesh.positions.size());
  for (const Vec3& p : coarse.positions) mesh.positions.push_back(0.7f * p + Vec3(5, 0, 0));
  for (Index f = 0; f < coarse.faces.size(); ++f) {
    const auto face = coarse.faces[f];
    mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
  }
  return mesh;
}

/// No mechanical part by all of its edges, but most of the sharp ones are clean and stick out.
TEST(Features, CreasesOfRoundedPartsAreFound) {
  Mesh mesh = rods();
  const auto found = rim_and_sharp_edges(mesh, flat_degrees, Context(1));
  ASSERT_EQ(kind_of_surface(mesh, found, Context(1)), SurfaceKind::rounded_part);
  EXPECT_EQ(find_features(mesh, {}, 0.2).size(), 4u);
  EXPECT_EQ(find_features(mesh, {}, 2).size(), 2u) << "one is too short for such faces";
  for (Index f = 0; f < mesh.faces.size(); ++f) std::swap(mesh.faces[f][0], mesh.faces[f][1]);
  EXPECT_TRUE(find_features(mesh, {}, 0.2).empty()) << "lines of a sculpture are hollow";
}

/// Faces cannot keep the two rims of a thin sheet apart, if it is very thin or much wider.
TEST(Features, OfCreasesBesideEachOtherTheFirstStays) {
  const auto lines_of_sheet = [](float thickness, double edge_length) {
    Mesh sheet = sample_shape("cube");
    for (Vec3& p : sheet.positions) p.z() *= thickness;
    return find_features(sheet, {}, edge_length);
  };
  const auto whole = {lines_of_sheet(0.01f, 0.01), lines_of_sheet(0.1f, 0.5)};
  for (const FeatureLines& lines : whole) {
    EXPECT_EQ(lines.size(), 12u);
    EXPECT_EQ(lines.corners.size(), 8u);
  }
  for (const double edge_length : {0.05, 0.2}) {
    const FeatureLines lines = lines_of_sheet(0.01f, edge_length);
    EXPECT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines.corners.size(), 4u);
    for (const Vec3& p : lines.positions) EXPECT_FLOAT_EQ(p.z(), lines.positions[0].z());
  }
}

/// Along the ridge of a roof: the share of its length that a crease covers which is told at its
/// first edges. `degrees(x)`: the angle between the sides of the ridge there, x from 0 to 1.
template <typename Degrees>
double followed_along_ridge(const Degrees& degrees) {
  constexpr Index steps = 20;
  Mesh roof;
  for (Index k = 0; k <= steps; ++k) {
    const double x = static_cast<double>(k) / steps;
    const double low = -std::tan(degrees(x) * std::numbers::pi / 360);
    for (const double y : {-1.0, 0.0, 1.0}) {
      roof.positions.push_back(Eigen::Vector3d(8 * x, y, y == 0 ? 0 : low).cast<float>());
    }
    if (k == 0) continue;
    for (const Index a : {3 * k - 3, 3 * k - 2}) {
      roof.faces.push_back(std::array<Index, 3>{a, a + 3, a + 4});
      roof.faces.push_back(std::array<Index, 3>{a, a + 4, a + 1});
    }
  }
  const auto edges = sharp_edges(roof, flat_degrees);
  std::vector<std::uint8_t> is_crease;
  for (const SharpEdge& edge : edges) {
    is_crease.push_back(edge.cosine < std::cos(50 * std::numbers::pi / 180));
  }
  follow_fading_creases(roof, edges, is_crease);
  double followed = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges[e].ends;
    EXPECT_TRUE(!is_crease[e] || (a % 3 == 1 && b % 3 == 1)) << "not along the ridge";
    followed += is_crease[e];
  }
  return followed / steps;
}

TEST(Features, CreasesAreFollowedWhereTheyBecomeFlat) {
  EXPECT_NEAR(followed_along_ridge([](double x) { return 60 * (1 - x); }), 1 - 10.0 / 60, 0.051);
  // Facets of what is round are another thing.
  EXPECT_NEAR(followed_along_ridge([](double x) { return x < 0.52 ? 60 : 20; }), 0.5, 0.051);
}

TEST(Features, CreasesAndCornersAreKept) {
  for (const char* name : {"cube", "cylinder", "bracket", "twisted-cube", "fused-boxes", "shaft"}) {
    const Mesh input = sample_shape(name);
    for (const std::size_t count : {500, 1000, 1500, 5000}) {
      for (const OutputFaces faces :
           {OutputFaces::quads, OutputFaces::quad_dominant, OutputFaces::triangles}) {
        SCOPED_TRACE(std::string(name) + " " + std::to_string(count) + " " +
                     std::to_string(static_cast<int>(faces)));
        RemeshOptions options;
        options.faces = faces;
        options.face_count = count;
        const Mesh output = remesh(input, options).mesh;
        made::expect_same_topology(mesh_statistics(output), mesh_statistics(input));
        const made::Kept kept = made::kept_creases(input, output);
        EXPECT_GE(kept.creases, faces == OutputFaces::triangles ? 0.97
                                : faces == OutputFaces::quads   ? 0.999
                                                                : 0.99);
        EXPECT_EQ(kept.corners, 1);
      }
    }
  }
}

/// A ring that is twisted as a rope of `strands` is, twice around.
Mesh rope(int strands) {
  return made::grid(120, 48, true, true, [strands](double u, double v) {
    const double a = 2 * std::numbers::pi * u, b = 2 * std::numbers::pi * (v + 2 * u);
    const double groove = std::abs(std::sin(std::numbers::pi * strands * v));
    const double r = 0.27 + 0.06 * groove, distance = 1 + r * std::cos(b);
    return Vec3(Eigen::Vector3d(distance * std::cos(a), distance * std::sin(a), r * std::sin(b))
                    .cast<float>());
  });
}

/// Where the surface bends along another way than its creases run.
TEST(Features, CrossesTurnToTheGroovesOfARope) {
  RemeshOptions options;
  options.face_count = 2000;
  const Mesh input = rope(4);
  const Mesh result = remesh(input, options).mesh;
  const MeshStatistics s = mesh_statistics(result);
  EXPECT_LE(s.irregular_vertices, 20u);
  EXPECT_LT(s.angle_sigma, 16);
  EXPECT_GT(made::kept_creases(input, result).creases, 0.99);
}

/// The largest angle between neighbours among the points on the circle of the shaft's upper end.
double widest_step_around(const Mesh& mesh) {
  std::vector<double> angles;
  for (const Vec3& p : mesh.positions) {
    const double radius = std::hypot(p.x(), p.z());
    if (p.y() > 0.999f && radius > 0.096) angles.push_back(std::atan2(p.z(), p.x()));
  }
  if (angles.empty()) return 2 * std::numbers::pi;
  std::sort(angles.begin(), angles.end());
  double widest = angles.front() + 2 * std::numbers::pi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i)
    widest = std::max(widest, angles[i] - angles[i - 1]);
  return widest;
}

/// Faces are nearly as large as the radius of the smallest circle.
TEST(Features, SmallCirclesStayCircles) {
  const Mesh input = sample_shape("shaft");
  for (const std::size_t count : {400, 500, 600, 700, 800, 1000}) {
    SCOPED_TRACE(count);
    RemeshOptions options;
    options.face_count = count;
    const Mesh output = remesh(input, options).mesh;
    EXPECT_NEAR(static_cast<double>(output.faces.size()), static_cast<double>(count),
                0.01 * static_cast<double>(count));
    EXPECT_LT(widest_step_around(output), count == 400 ? 1.25 : 1.05);
  }
}

/// Many rows end on the hole's side towards the rim of the plate, and few on the other one.
TEST(Features, RimsOfHolesKeepTheirCurve) {
  double creases = 0;
  int runs = 0;
  for (const double resolution : {1.8, 2.0, 2.2}) {
    const Mesh input = sample_shape("bracket", resolution);
    for (std::size_t count = 440; count <= 560; count += 20, ++runs) {
      RemeshOptions options;
      options.face_count = count;
      creases += made::kept_creases(input, remesh(input, options).mesh).creases;
    }
  }
  EXPECT_GT(creases / runs, 0.998);
}

/// Lattices of 4 and of 5 cells meet on the sides of the first two.
TEST(Features, EdgesOfADenseCubeStayStraight) {
  const Mesh input = sample_shape("cube", 4);
  for (const std::size_t count : {500, 550, 5000}) {
    SCOPED_TRACE(count);
    RemeshOptions options;
    options.face_count = count;
    const Mesh output = remesh(input, options).mesh;
    const made::Kept kept = made::kept_creases(input, output);
    EXPECT_GT(kept.creases, 0.9999);
    EXPECT_EQ(kept.corners, 1);
    for (const Vec3& p : output.positions) EXPECT_NEAR(p.cwiseAbs().maxCoeff(), 0.5, 1e-4);
  }
}

/// The sides of voxels that are in a ball, where no others are beside them.
Mesh voxel_ball(double radius) {
  const int n = static_cast<int>(radius) + 2;
  const auto is_in = [&](const std::array<int, 3>& p) {
    double sum = 0;
    for (const int x : p) sum += (x + 0.5) * (x + 0.5);
    return sum < radius * radius;
  };
  Mesh mesh;
  std::map<std::array<int, 3>, Index> vertices;
  const auto vertex = [&](const std::array<int, 3>& p) {
    const auto [it, is_new] = vertices.emplace(p, static_cast<Index>(mesh.positions.size()));
    if (is_new) mesh.positions.push_back(Eigen::Vector3i(p[0], p[1], p[2]).cast<float>());
    return it->second;
  };
  for (int k = 0; k < 8 * n * n * n; ++k) {
    const std::array<int, 3> voxel{k % (2 * n) - n, k / (2 * n) % (2 * n) - n, k / (4 * n * n) - n};
    if (!is_in(voxel)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        std::array<int, 3> beside = voxel;
        beside[axis] += 2 * side - 1;
        if (is_in(beside)) continue;
        std::array<Index, 4> face{};
        constexpr int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        for (std::size_t c = 0; c < 4; ++c) {
          std::array<int, 3> p = voxel;
          p[axis] += side;
          p[(axis + 1) % 3] += around[c][0];
          p[(axis + 2) % 3] += around[c][1];
          face[side == 1 ? c : 3 - c] = vertex(p);
        }
        mesh.faces.push_back(face);
      }
    }
  }
  return mesh;
}

/// Faces larger than a step cannot have it as an edge.
/// As many faces as were asked for, none inverted, and the input's topology.
void expect_sound(const Mesh& mesh, const Mesh& input, std::size_t count) {
  const MeshStatistics s = mesh_statistics(mesh);
  made::expect_same_topology(s, mesh_statistics(input));
  const auto wanted = static_cast<double>(count);
  EXPECT_NEAR(static_cast<double>(s.faces), wanted, 0.01 * wanted);
  EXPECT_EQ(s.inverted_quads, 0u);
}

/// A square column, turned by so many turns on its way up in so many steps.
Mesh twisted_column(int steps, double turns) {
  constexpr double height = 6;
  Mesh mesh;
  for (int k = 0; k <= steps; ++k) {
    const double up = static_cast<double>(k) / steps;
    for (int corner = 0; corner < 4; ++corner) {
      const double angle = (0.25 * corner + turns * up) * 2 * std::numbers::pi;
      mesh.positions.push_back(
          Eigen::Vector3d(std::cos(angle), std::sin(angle), height * up).cast<float>());
    }
  }
  for (Index k = 0; k < static_cast<Index>(steps); ++k) {
    for (Index corner = 0; corner < 4; ++corner) {
      const Index a = 4 * k + corner, b = 4 * k + (corner + 1) % 4;
      mesh.faces.push_back({a, b, b + 4});
      mesh.faces.push_back({a, b + 4, a + 4});
    }
  }
  const auto top = static_cast<Index>(4 * steps);
  mesh.faces.push_back({3, 2, 1, 0});
  mesh.faces.push_back({top, top + 1, top + 2, top + 3});
  return mesh;
}

/// There are more of them than edges; followed they make more than twice the faces.
TEST(Features, FacetsOfATwistedColumnAreNoCreasesOfCoarseFaces) {
  const Mesh column = twisted_column(60, 1);
  RemeshOptions options;
  for (const std::size_t count : {300u, 1000u}) {
    options.face_count = count;
    const RemeshResult result = remesh(column, options);
    expect_sound(result.mesh, column, count);
    ASSERT_EQ(result.report.notes.size(), 1u);
    EXPECT_TRUE(result.report.notes[0].starts_with("without creases: there are about as many"));
  }
  options.features.creases = Creases::by_angle;  // those that are asked for stay
  const RemeshResult followed = remesh(column, options);
  made::expect_same_topology(mesh_statistics(followed.mesh), mesh_statistics(column));
  EXPECT_GT(followed.mesh.faces.size(), 2 * options.face_count);
}

/// A cone of height 2 over a disk.
Mesh made_cone(Index sides, float radius) {
  Mesh cone;
  cone.positions = {{0, 0, 2}, {0, 0, 0}};
  for (Index k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    cone.positions.push_back(
        Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0).cast<float>());
    const Index a = 2 + k, b = 2 + (k + 1) % sides;
    cone.faces.push_back({0, a, b});
    cone.faces.push_back({1, b, a});
  }
  return cone;
}

TEST(Features, TipsOfConesStay) {
  const Mesh cone = made_cone(48, 1);
  for (const OutputFaces faces :
       {OutputFaces::quads, OutputFaces::quad_dominant, OutputFaces::triangles}) {
    RemeshOptions options;
    options.faces = faces;
    options.face_count = 600;
    const Mesh result = remesh(cone, options).mesh;
    const auto is_tip = [&](const Vec3& p) {
      const Eigen::Vector3d at = result.origin + p.cast<double>();
      return (at - Eigen::Vector3d(0, 0, 2)).norm() < 1e-5;
    };
    EXPECT_EQ(std::ranges::count_if(result.positions, is_tip), 1);
    made::expect_same_topology(mesh_statistics(result), mesh_statistics(cone));
  }
}

TEST(Features, OnlyConesHaveTips) {
  const auto tips = [](const Mesh& mesh, double edge_length) {
    return find_cone_tips(mesh, build_graph(mesh), find_features(mesh, {}, edge_length),
                          edge_length, Context());
  };
  const auto cone = [](Index sides, float radius) {
    Mesh mesh = made_cone(sides, radius);
    subdivide(mesh, 0.1, Context());
    return mesh;
  };
  EXPECT_EQ(tips(cone(48, 1), 0.3), std::vector<Index>{0});
  EXPECT_TRUE(tips(cone(48, 1), 3).empty()) << "its rim is nearer";
  EXPECT_TRUE(tips(cone(48, 4), 0.3).empty()) << "too flat";
  EXPECT_TRUE(tips(cone(5, 1), 0.3).empty()) << "a pyramid, whose creases meet";
  for (const char* name : {"blob", "sphere", "bracket"}) {
    Mesh shape = triangulate(sample_shape(name));
    const double edge_length = 3 * edge_lengths(shape).mean;
    EXPECT_TRUE(tips(shape, edge_length).empty()) << name;
    add_noise(shape, 0.3);
    EXPECT_TRUE(tips(shape, edge_length).empty()) << name << " with noise";
  }
}

/// Which faces of a mesh over a flat square look down.
std::size_t turned_over(const Mesh& flat) {
  std::size_t count = 0;
  for (std::size_t f = 0; f < flat.faces.size(); ++f) {
    count += area_vector(flat.faces[f], flat.positions).z() < 0;
  }
  return count;
}

/// Faces with corners on both sides of a circle, farther from it than that.
std::size_t faces_across(const Mesh& flat, float radius, float most) {
  std::size_t count = 0;
  for (std::size_t f = 0; f < flat.faces.size(); ++f) {
    float least = radius, greatest = radius;
    for (const Index v : flat.faces[f]) {
      const Eigen::Vector3d p = flat.origin + flat.positions[v].cast<double>();
      const auto distance = static_cast<float>(p.head<2>().norm());
      least = std::min(least, distance);
      greatest = std::max(greatest, distance);
    }
    count += least < radius - most && greatest > radius + most;
  }
  return count;
}

/// Where two materials meet along the sides of squares, in steps about as long as a face.
TEST(Features, RaggedMarksAreFollowedEvenly) {
  int without_some = 0;
  for (const Index side : {20u, 40u}) {
    const float half = static_cast<float>(side) / 2, radius = 0.66f * half;
    Mesh square;
    const auto at = [&](Index x, Index y) { return y * (side + 1) + x; };
    const auto is_inside = [&](Index x, Index y) {
      return std::hypot(static_cast<float>(x) + 0.5f - half, static_cast<float>(y) + 0.5f - half) <
             radius;
    };
    for (Index y = 0; y <= side; ++y) {
      for (Index x = 0; x <= side; ++x) {
        square.positions.push_back({static_cast<float>(x) - half, static_cast<float>(y) - half, 0});
        if (x == side || y == side) continue;
        square.faces.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
        if (x == 0 || y == 0) continue;
        if (is_inside(x, y) != is_inside(x - 1, y)) {
          square.marked_edges.push_back({at(x, y), at(x, y + 1)});
        }
        if (is_inside(x, y) != is_inside(x, y - 1)) {
          square.marked_edges.push_back({at(x, y), at(x + 1, y)});
        }
      }
    }
    for (const std::size_t faces : {200u, 300u, 500u, 800u}) {
      SCOPED_TRACE(std::to_string(side) + " squares, " + std::to_string(faces) + " faces");
      RemeshOptions options;
      options.face_count = faces;
      const RemeshResult result = remesh(square, options);
      expect_sound(result.mesh, square, faces);
      EXPECT_EQ(turned_over(result.mesh), 0u);
      EXPECT_FALSE(made::has_note(result, "without creases"));
      if (made::has_note(result, "without some")) {
        ++without_some;
        continue;
      }
      EXPECT_LT(mesh_statistics(result.mesh).angle_sigma, 18);
      EXPECT_LE(faces_across(result.mesh, radius, 0.7f), faces / 50);
    }
  }
  EXPECT_LE(without_some, 1);
}

/// Of unit sides, so many in a row, from the origin on.
Mesh field_of_squares(Index side) {
  Mesh field;
  const auto at = [&](Index x, Index y) { return y * (side + 1) + x; };
  for (Index y = 0; y <= side; ++y) {
    for (Index x = 0; x <= side; ++x) {
      field.positions.push_back({static_cast<float>(x), static_cast<float>(y), 0});
      if (x == 0 || y == 0) continue;
      field.faces.push_back({at(x - 1, y - 1), at(x, y - 1), at(x, y), at(x - 1, y)});
    }
  }
  return field;
}

/// Stripes much narrower than faces: those that follow them would bite pieces out of the border.
TEST(Features, MarksGoWhereTheyAreAsManyAsEdges) {
  constexpr Index side = 60;
  Mesh square = field_of_squares(side);
  const auto at = [](Index x, Index y) { return y * (side + 1) + x; };
  for (Index x = 2; x < side; x += 2) {
    for (Index y = 1; y <= side; ++y) square.marked_edges.push_back({at(x, y - 1), at(x, y)});
  }
  RemeshOptions options;
  options.face_count = 200;
  const RemeshResult result = remesh(square, options);
  expect_sound(result.mesh, square, options.face_count);
  EXPECT_TRUE(made::has_note(result, "without creases and marked edges"));
  EXPECT_NEAR(surface_area(result.mesh), side * side, 1e-3 * side * side);
}

/// The borders of materials, such as the lanes of a running track, much narrower than faces.
TEST(Features, MarksYieldToSoundFaces) {
  constexpr Index side = 80;
  Mesh field = field_of_squares(side);
  const auto at = [](Index x, Index y) { return y * (side + 1) + x; };
  for (Index lane = 20; lane < 30; ++lane) {  // rings
    const Index last = side - lane;
    for (Index k = lane; k < last; ++k) {
      for (const Index fixed : {lane, last}) {
        field.marked_edges.push_back({at(k, fixed), at(k + 1, fixed)});
        field.marked_edges.push_back({at(fixed, k), at(fixed, k + 1)});
      }
    }
  }
  for (Index k = 10; k < 70; ++k) {  // and short lines across them
    const Index y = k % 40 + 20;
    field.marked_edges.push_back({at(k, y), at(k + 1, y)});
  }
  RemeshOptions options;
  options.face_count = 150;
  const RemeshResult result = remesh(field, options);
  expect_sound(result.mesh, field, options.face_count);
  ASSERT_EQ(result.report.notes.size(), 1u);
  EXPECT_TRUE(result.report.notes[0].starts_with("without creases and marked edges: "));
}

TEST(Features, StepsOfVoxelsYieldToSoundFaces) {
  const Mesh ball = voxel_ball(11);
  ASSERT_GT(features_of(triangulate(ball)).size(), 500u);
  const auto says_so = [](const RemeshResult& of) { return made::has_note(of, "without creases"); };
  RemeshOptions options;
  // Faces that follow the steps pass through each other, of the larger number a few; but then there
  // are more than twice as many.
  for (const std::size_t count : {300u, 800u}) {
    options.face_count = count;
    const RemeshResult result = remesh(ball, options);
    expect_sound(result.mesh, ball, count);
    EXPECT_LE(mesh_statistics(result.mesh).irregular_vertices, 16u);
    EXPECT_TRUE(find_crossings(result.mesh, Context()).empty());
    EXPECT_TRUE(says_so(result));
  }
  options.face_count = 300;
  options.features.creases = Creases::by_angle;  // those that are asked for stay
  EXPECT_FALSE(says_so(remesh(ball, options)));
}

/// A block with ten grooves in a corner of its top, far narrower than a face.
Mesh grooved_block() {
  std::set<made::Cell> cells;
  for (int x = 0; x < 32; ++x) {
    for (int y = 0; y < 32; ++y) {
      const bool is_groove = x % 2 == 1 && x < 12 && y >= 2 && y < 12;
      for (int z = 0; z < (is_groove ? 14 : 16); ++z) cells.insert({x, y, z});
    }
  }
  return made::surface_of_cells(cells);
}

/// As all of them did, which made a sack of the block.
TEST(Features, CreasesYieldToSoundFacesOnlyWhereTheyAreCrowded) {
  const Mesh block = grooved_block();
  RemeshOptions options;
  options.face_count = 200;
  const RemeshResult result = remesh(block, options);
  expect_sound(result.mesh, block, options.face_count);
  EXPECT_TRUE(find_crossings(result.mesh, Context()).empty());
  ASSERT_EQ(result.report.notes.size(), 1u);
  EXPECT_TRUE(result.report.notes[0].starts_with("without some creases: "));
  std::set<made::Cell> all;
  for (int k = 0; k < 32 * 32 * 16; ++k) all.insert({k % 32, k / 32 % 32, k / 32 / 32});
  EXPECT_GT(made::kept_creases(made::surface_of_cells(all), result.mesh).creases, 0.6);
}

}  // namespace
}  // namespace meshgrain
