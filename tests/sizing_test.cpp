#include "meshgrain/sizing.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "field/bending.h"
#include "made_graph.h"
#include "meshgrain/error.h"
#include "meshgrain/remesh.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"

namespace meshgrain {
namespace {

constexpr OutputFaces kinds[] = {OutputFaces::quads, OutputFaces::quad_dominant,
                                 OutputFaces::triangles};

/// How strongly each vertex of a mesh bends, over patches of this area.
std::vector<float> bends(const Mesh& mesh, double area) {
  return bending(build_hierarchy(build_graph(mesh)), mesh, {}, area, Context());
}

/// The largest error of what is told of the vertices of a mesh, relative to what should be.
template <typename Truth>
double worst_error(const Mesh& mesh, double area, const Truth& truth) {
  const std::vector<float> found = bends(mesh, area);
  double worst = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    worst = std::max(worst, std::abs(found[i] / truth(mesh.positions[i]) - 1));
  }
  return worst;
}

TEST(Bending, OfASphere) {
  Mesh mesh = sample_shape("sphere", 2);
  for (Vec3& p : mesh.positions) p *= 0.5f;
  const auto truth = [](const Vec3&) { return 2 * std::sqrt(2.0); };
  EXPECT_LT(worst_error(mesh, 0.01, truth), 0.08);
  // Flat triangles between edges are no less round.
  subdivide(mesh, 0.3 * edge_lengths(mesh).mean);
  EXPECT_LT(worst_error(mesh, 0.01, truth), 0.08);
  // Nor is noise rounder: of a hundredth of the radius, over edges of a twentieth.
  EXPECT_LT(worst_error(made::shaken(sample_shape("sphere", 2), 0.005f), 0.3,
                        [](const Vec3&) { return std::sqrt(2.0); }),
            0.2);
}

TEST(Bending, OfATorus) {
  const Mesh mesh = sample_shape("torus", 2);
  EXPECT_LT(worst_error(mesh, 0.004,
                        [](const Vec3& p) {
                          const double radius = std::hypot(p.x(), p.y());
                          const double around = (radius - 1) / 0.4 / radius;
                          return std::hypot(around, 1 / 0.4);
                        }),
            0.08);
}

TEST(Bending, IsNotThatOfCreases) {
  const Mesh mesh = sample_shape("cube", 1);
  const Hierarchy hierarchy = build_hierarchy(build_graph(mesh));
  const FeatureLines creases = find_features(mesh, {}, 0.1);
  ASSERT_FALSE(creases.empty());
  for (const float bend : bending(hierarchy, mesh, creases, 0.01, Context())) {
    EXPECT_NEAR(bend, 0, 1e-4);
  }
  const std::vector<float> with_them = bends(mesh, 0.01);
  EXPECT_GT(*std::max_element(with_them.begin(), with_them.end()), 5);
}

TEST(Grading, IsTheLargestBelowThatGrowsSoSlowly) {
  const Graph graph = made::noisy_graph();
  std::vector<float> lengths;
  for (std::size_t i = 0; i < graph.size(); ++i) {
    lengths.push_back(i % 53 == 0 ? 0.01f : 0.5f + 0.3f * made::noise(i));
  }
  const double growth = 0.25;
  const EdgeLength found = graded(graph, EdgeLength(lengths), growth);
  // The plainest form: until nothing changes.
  std::vector<float> expected = lengths;
  for (bool changed = true; changed;) {
    changed = false;
    for (Index i = 0; i < graph.size(); ++i) {
      for (const Index j : graph.neighbors_of(i)) {
        const double distance = (graph.positions[i] - graph.positions[j]).norm();
        const auto most = static_cast<float>(expected[j] + growth * distance);
        if (expected[i] <= most) continue;
        expected[i] = most;
        changed = true;
      }
    }
  }
  EXPECT_EQ(found.values, expected);
  EXPECT_NE(found.values, lengths);
}

/// A plate whose wanted lengths jump from 1 to 6 at x = 0.
Mesh jumping_plate() {
  Mesh plate = sample_shape("plate");
  for (const Vec3& p : plate.positions) plate.values.push_back(p.x() < 0 ? 1.0f : 6.0f);
  return plate;
}

TEST(Grading, BoundsTheGrowthOverThreeFaces) {
  for (const OutputFaces kind : kinds) {
    for (const double grading : {1.3, 2.0}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(kind)) + " " + std::to_string(grading));
      RemeshOptions options;
      options.faces = kind;
      options.face_count = 900;
      options.sizing.kind = Sizing::Kind::values;
      options.sizing.grading = grading;
      const RemeshResult result = remesh(jumping_plate(), options);
      EXPECT_NEAR(static_cast<double>(result.mesh.faces.size()), 900, 9);
      // Lengths of the lattice, twice as long as the sides of pure quads.
      const double sides = kind == OutputFaces::quads ? 2 : 1;
      const auto& lengths = result.fields.position.edge_length.values;
      const Graph graph = build_graph(result.fields.surface);
      ASSERT_EQ(lengths.size(), graph.size());
      double steepest = 0;
      for (Index i = 0; i < graph.size(); ++i) {
        for (const Index j : graph.neighbors_of(i)) {
          const double distance = (graph.positions[i] - graph.positions[j]).norm();
          steepest = std::max(steepest, (lengths[i] - lengths[j]) / distance);
        }
      }
      const double growth = sides * std::log(grading) / 3;
      EXPECT_LT(steepest, growth + 1e-4);
      EXPECT_GT(steepest, 0.95 * growth);
      const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
      EXPECT_GT(*most / *least, grading == 2 ? 4 : 2);
    }
  }
}

RemeshOptions adaptive(double adaptive, std::size_t faces, OutputFaces kind = OutputFaces::quads) {
  RemeshOptions options;
  options.faces = kind;
  options.face_count = faces;
  options.sizing.adaptive = adaptive;
  return options;
}

/// How strongly an ellipsoid of half axes 3, 1 and 1 bends where x is this.
double ellipsoid_bend(double x) {
  const double cosine2 = x * x / 9, d = 9 * (1 - cosine2) + cosine2;
  return std::hypot(3 / (d * std::sqrt(d)), 3 / std::sqrt(d));
}

TEST(Adaptive, FacesAreAsLargeAsTheCurvatureSays) {
  EXPECT_NEAR(ellipsoid_bend(3), std::hypot(3.0, 3.0), 1e-6);
  EXPECT_NEAR(ellipsoid_bend(0), std::hypot(1.0, 1.0 / 9), 1e-6);
  Mesh ellipsoid = sample_shape("sphere");
  for (Vec3& p : ellipsoid.positions) p.x() *= 3;
  for (const OutputFaces kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind));
    const Mesh mesh = remesh(ellipsoid, adaptive(1, 3000, kind)).mesh;
    EXPECT_NEAR(static_cast<double>(mesh.faces.size()), 3000, 30);
    // Faces are to be as large as 1 / bend^(2/3): at the ends and in the middle, measured so, they
    // are the same. Measured in units of area they are not.
    std::array<double, 2> area{}, measured{}, count{};
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      double x = 0;
      for (const Index v : mesh.faces[f]) x += std::abs(mesh.positions[v].x());
      x = std::min(3.0, x / static_cast<double>(mesh.faces[f].size()));
      if (x > 0.8 && x < 2.8) continue;
      area[x > 1] += face_area(mesh, f);
      measured[x > 1] += face_area(mesh, f) * std::pow(ellipsoid_bend(x), 2.0 / 3);
      count[x > 1] += 1;
    }
    ASSERT_GT(count[1], 100);
    EXPECT_NEAR((measured[0] / count[0]) / (measured[1] / count[1]), 1, 0.15);
    EXPECT_GT((area[0] / count[0]) / (area[1] / count[1]), 1.5);
  }
}

TEST(Adaptive, IsNearerToTheSurface) {
  for (const char* name : {"blob", "three-holes"}) {
    SCOPED_TRACE(name);
    const Mesh input = sample_shape(name, 1);
    const auto distance = [&](const RemeshOptions& options) {
      const Mesh mesh = remesh(input, options).mesh;
      EXPECT_NEAR(static_cast<double>(mesh.faces.size()), 1500, 15);
      EXPECT_EQ(mesh_statistics(mesh).inverted_quads, 0u);
      const double diagonal = bounding_diagonal(input);
      return surface_distance(mesh, input, diagonal).mean +
             surface_distance(input, mesh, diagonal).mean;
    };
    const double uniform = distance(adaptive(0, 1500));
    EXPECT_LT(distance(adaptive(1, 1500)), 0.75 * uniform);
    EXPECT_LT(distance(adaptive(0.5, 1500)), 0.95 * uniform);
  }
}

TEST(Adaptive, RimsOfHolesBendToo) {
  // A flat ring, of radii 0.2 and 2.
  constexpr Index around = 96, across = 40;
  Mesh ring;
  for (Index j = 0; j <= across; ++j) {
    for (Index i = 0; i < around; ++i) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / around;
      const float radius = 0.2f + 1.8f * static_cast<float>(j) / across;
      ring.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
  }
  for (Index j = 0; j < across; ++j) {
    for (Index i = 0; i < around; ++i) {
      const Index next = (i + 1) % around;
      const Index a = j * around + i, b = j * around + next;
      ring.faces.push_back({a, a + around, b + around});
      ring.faces.push_back({a, b + around, b});
    }
  }
  const auto ratio = [&](double strength) {
    const Mesh mesh = remesh(ring, adaptive(strength, 1200)).mesh;
    EXPECT_NEAR(static_cast<double>(mesh.faces.size()), 1200, 12.1);
    std::array<double, 2> area{}, count{};
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const float radius = mesh.positions[mesh.faces[f][0]].norm();
      if ((radius > 0.3f && radius < 0.9f) || radius > 1.5f) continue;
      area[radius > 0.5f] += face_area(mesh, f);
      count[radius > 0.5f] += 1;
    }
    return (area[1] / count[1]) / (area[0] / count[0]);
  };
  EXPECT_NEAR(ratio(0), 1, 0.3);
  EXPECT_GT(ratio(1), 2);
}

TEST(Adaptive, LeavesASphereEven) {
  const Mesh mesh = remesh(sample_shape("sphere"), adaptive(1, 1500)).mesh;
  EXPECT_LT(mesh_statistics(mesh).area_sigma, 0.2);
  // Its faces are as far outside of it as inside.
  const auto volume_of = [](const Mesh& m) {
    double volume = 0;
    for (std::size_t f = 0; f < m.faces.size(); ++f) {
      const auto face = m.faces[f];
      for (std::size_t k = 2; k < face.size(); ++k) {
        volume +=
            m.positions[face[0]].dot(m.positions[face[k - 1]].cross(m.positions[face[k]])) / 6;
      }
    }
    return volume;
  };
  const double ball = volume_of(sample_shape("sphere"));
  const double inside = volume_of(remesh(sample_shape("sphere"), adaptive(0, 1500)).mesh);
  const double fitted = volume_of(remesh(sample_shape("sphere"), adaptive(1, 1500)).mesh);
  EXPECT_LT(std::abs(fitted - ball), 0.15 * std::abs(inside - ball));
}

TEST(Adaptive, RefusesWhatMakesNoSense) {
  RemeshOptions options = adaptive(1.5, 100);
  EXPECT_THROW(remesh(sample_shape("sphere", 0.5), options), Error);
  options = adaptive(0.5, 100);
  options.sizing.grading = 1;
  EXPECT_THROW(remesh(sample_shape("sphere", 0.5), options), Error);
}

/// Mean face areas where x is negative and where it is positive, by `distance` at least.
std::array<double, 2> mean_areas(const Mesh& mesh, double distance) {
  std::array<double, 2> area{}, count{};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    float x = 0;
    for (const Index v : mesh.faces[f]) x += mesh.positions[v].x();
    x /= static_cast<float>(mesh.faces[f].size());
    if (std::abs(x) < distance) continue;
    area[x > 0] += face_area(mesh, f);
    count[x > 0] += 1;
  }
  return {area[0] / count[0], area[1] / count[1]};
}

class PaintedHalves
    : public testing::TestWithParam<std::tuple<const char*, OutputFaces, std::size_t>> {};

TEST_P(PaintedHalves, FourTimesTheDensityIsAQuarterOfTheArea) {
  const auto& [name, kind, count] = GetParam();
  Mesh mesh = sample_shape(name);
  for (Vec3& p : mesh.positions) p *= std::string(name) == "plate" ? 2.0f : 1.0f;
  for (const Vec3& p : mesh.positions) mesh.values.push_back(p.x() < 0 ? 12.0f : 3.0f);
  RemeshOptions options;
  options.faces = kind;
  options.face_count = count;
  options.sizing.kind = Sizing::Kind::density;
  // A thousand faces have hardly room for a slow change, and come in few rows.
  const bool few = count < 2000;
  if (few) options.sizing.grading = 4;
  const double coarse_side = std::sqrt(surface_area(mesh) / 2 / (static_cast<double>(count) / 5));
  const double transition = (few ? 2 : 4) * coarse_side;
  const Mesh by_number = remesh(mesh, options).mesh;
  EXPECT_NEAR(static_cast<double>(by_number.faces.size()) / static_cast<double>(count), 1, 0.0101);
  const auto [dense, coarse] = mean_areas(by_number, transition);
  EXPECT_NEAR(coarse / dense, 4, 0.4);
  if (!few) return;

  // Red and white are the same as four and one.
  for (float& value : mesh.values) value = value == 12 ? 1.0f : 0.0f;
  options.sizing.kind = Sizing::Kind::paint;
  const auto [red, white] = mean_areas(remesh(mesh, options).mesh, transition);
  EXPECT_NEAR(white / red, 4, 0.4);
}

INSTANTIATE_TEST_SUITE_P(Shapes, PaintedHalves,
                         testing::Combine(testing::Values("plate", "sphere"),
                                          testing::ValuesIn(kinds),
                                          testing::Values(std::size_t{1000}, std::size_t{5000})));

/// With one node a face, and more vertices than faces.
TEST(Sizing, FacesAsNodesHaveSizesToo) {
  Mesh loose;
  for (int k = 0; k < 40; ++k) {
    const auto x = static_cast<float>(2 * k);
    const auto first = static_cast<Index>(loose.positions.size());
    loose.positions.insert(loose.positions.end(),
                           {Vec3(x, 0, 0), Vec3(x + 1, 0, 0), Vec3(x, 1, 0)});
    loose.faces.push_back(std::array<Index, 3>{first, first + 1, first + 2});
  }
  RemeshOptions options;
  options.graph.nodes = GraphNodes::faces;
  options.sizing.adaptive = 1;
  EXPECT_NO_THROW(remesh(loose, options));
  Mesh plate = sample_shape("plate", 0.5);
  options.sizing = {};
  options.sizing.kind = Sizing::Kind::density;
  plate.values.assign(plate.positions.size(), 1);
  EXPECT_THROW(remesh(plate, options), Error);
}

TEST(Painted, NumbersMustBePositiveAndPaintInBounds) {
  Mesh mesh = sample_shape("plate", 0.5);
  RemeshOptions options;
  options.face_count = 100;
  options.sizing.kind = Sizing::Kind::density;
  EXPECT_THROW(remesh(mesh, options), Error);
  mesh.values.assign(mesh.positions.size(), 0);
  EXPECT_THROW(remesh(mesh, options), Error);
  options.sizing.kind = Sizing::Kind::paint;
  EXPECT_NO_THROW(remesh(mesh, options));
  mesh.values[3] = 1.5;
  EXPECT_THROW(remesh(mesh, options), Error);
}

}  // namespace
}  // namespace meshgrain
