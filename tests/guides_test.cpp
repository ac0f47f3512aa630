#include "meshgrain/guides.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "features/find_features.h"
#include "made_guides.h"
#include "mesh/edges.h"
#include "meshgrain/error.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

using made::Point;
using std::numbers::pi;

Guide segment(const Point& a, const Point& b) {
  return {{a, b}};
}

Guide circle(double radius) {
  Guide guide = made::guide_along([&](double t) -> Point {
    return {radius * std::cos(2 * pi * t), radius * std::sin(2 * pi * t), 0};
  });
  guide.points.pop_back();
  guide.closed = true;
  return guide;
}

/// Three times around the unit sphere, from near one pole to near the other.
Guide spiral() {
  return made::guide_along(
      [](double t) -> Point {
        const double z = 0.9 - 1.8 * t, r = std::sqrt(1 - z * z);
        return {r * std::cos(6 * pi * t), r * std::sin(6 * pi * t), z};
      },
      600);
}

Guide through_middle(const Mesh& mesh, const Point& normal) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.positions) box.extend(p.cast<double>());
  return made::section(mesh, normal, normal.dot(box.center()));
}

struct Strokes {
  const char* name;
  const char* shape;
  std::vector<Guide> guides;
};

std::vector<Strokes> all_strokes() {
  const Point a(0.3, 1, 0.2), b(1, 0.3, -0.5);
  const Mesh blob = sample_shape("blob"), twisted = sample_shape("twisted-cube");
  return {
      {"straight", "plate", {segment({-0.3, 0.11, 0}, {0.35, 0.11, 0})}},
      {"diagonal", "plate", {segment({-0.3, -0.3, 0}, {0.3, 0.3, 0})}},
      {"circle", "plate", {circle(0.3)}},
      {"cross",
       "plate",
       {segment({-0.3, -0.3, 0}, {0.3, 0.3, 0}), segment({-0.3, 0.3, 0}, {0.3, -0.25, 0})}},
      {"spiral", "sphere", {spiral()}},
      {"arcs", "sphere", {made::arc({1, 0.3, 0.2}, 0, 2.5), made::arc({0.1, 0.9, 0.4}, 1, 4.5)}},
      {"loop", "blob", {through_middle(blob, a)}},
      {"crossing loops", "blob", {through_middle(blob, a), through_middle(blob, b)}},
      {"loop", "twisted-cube", {through_middle(twisted, a)}}};
}

TEST(Guides, AreFollowed) {
  for (const auto& [name, shape, guides] : all_strokes()) {
    const Mesh input = sample_shape(shape);
    for (const std::size_t count : {1000, 5000}) {
      for (const OutputFaces faces :
           {OutputFaces::quads, OutputFaces::quad_dominant, OutputFaces::triangles}) {
        SCOPED_TRACE(std::string(name) + " on " + shape + ", " + std::to_string(count) + ", kind " +
                     std::to_string(static_cast<int>(faces)));
        RemeshOptions options;
        options.faces = faces;
        options.face_count = count;
        options.guides = guides;
        const Mesh output = remesh(input, options).mesh;
        const MeshStatistics statistics = mesh_statistics(output);
        made::expect_same_topology(statistics, mesh_statistics(input));
        EXPECT_EQ(statistics.inverted_quads, 0u);
        const auto wanted = static_cast<double>(count);
        EXPECT_NEAR(static_cast<double>(statistics.faces), wanted, 0.01 * wanted);
        // Where a loop bends most, the ends of an edge that follows it to within .04 of its length
        // turn from it by 10 to 17 degrees if there are but 1,000 triangles.
        const bool has_long_edges = faces == OutputFaces::triangles && count == 1000;
        EXPECT_GE(made::followed(guides, output), has_long_edges ? 0.93 : 0.95);
      }
    }
  }
}

/// Without the option it is not by chance that edges lie there.
TEST(Guides, AreNotFollowedUnlessGiven) {
  RemeshOptions options;
  options.face_count = 1000;
  const Mesh output = remesh(sample_shape("plate"), options).mesh;
  EXPECT_LT(made::followed({segment({-0.3, -0.3, 0}, {0.3, 0.3, 0})}, output), 0.1);
  EXPECT_LT(made::followed({circle(0.3)}, output), 0.5);
}

TEST(Guides, AreCutIntoTheSurfaceWhichStaysTheSame) {
  for (const char* name : {"plate", "sphere"}) {
    SCOPED_TRACE(name);
    const Mesh before = sample_shape(name, 0.5);
    std::vector<Guide> guides{segment({-0.31, -0.22, 0}, {0.33, 0.27, 0})};
    if (std::string(name) == "sphere") guides = {spiral(), made::arc({0.5, 1, 0}, 0, 5)};
    const TracedGuides traced = trace_guides(before, guides, {}, 0.05, 1);
    EXPECT_TRUE(traced.notes.empty());
    ASSERT_EQ(traced.runs.size(), guides.size());
    Mesh mesh = before;
    const GuideLines lines = cut_guides(mesh, traced.runs, Context());
    EXPECT_NEAR(surface_area(mesh), surface_area(before), 1e-5);
    EXPECT_LT(surface_distance(mesh, before, 1, 2000).max, 1e-5);
    EXPECT_LT(surface_distance(before, mesh, 1, 2000).max, 1e-5);
    made::expect_same_topology(mesh_statistics(mesh), mesh_statistics(before));
    // Chains of edges of the mesh: inner vertices have two of them, or four where guides cross.
    std::set<std::array<Index, 2>> edges;
    for (const auto& [a, b, uses] : edges_of(mesh)) edges.insert({a, b});
    std::map<Index, int> degree;
    for (const EdgeOfLine& edge : lines.edges) {
      EXPECT_EQ(edges.count(edge.ends), 1u);
      for (const Index v : edge.ends) ++degree[v];
    }
    std::size_t ends = 0;
    for (const auto& [v, count] : degree) {
      ends += count == 1;
      EXPECT_TRUE(count == 1 || count == 2 || count == 4) << count;
    }
    EXPECT_EQ(ends, 2 * guides.size());
    EXPECT_EQ(lines.vertices.size(), degree.size());
  }
}

TEST(Guides, EndAtLinesCloseBy) {
  const Mesh plate = sample_shape("plate");
  const std::vector<EdgeOfLine> border = feature_edges(plate, {}, 0.1, Context());
  const double edge = 0.05;
  const auto runs = [&](const std::vector<Guide>& guides) {
    return trace_guides(plate, guides, border, edge, 1).runs;
  };
  // An end a third of an edge from the border, and one two edges from it.
  const auto near = runs({segment({0, 0, 0}, {0.5 - 0.33 * edge, 0.1, 0})});
  ASSERT_EQ(near.size(), 1u);
  EXPECT_NEAR(near[0].points.back().position.x(), 0.5, 1e-6);
  const auto away = runs({segment({0, 0, 0}, {0.5 - 2 * edge, 0.1, 0})});
  EXPECT_NEAR(away[0].points.back().position.x(), 0.5 - 2 * edge, 1e-6);
  // What goes on past the border ends there.
  const auto past = runs({segment({0, 0, 0}, {0.8, 0.1, 0})});
  ASSERT_EQ(past.size(), 1u);
  EXPECT_NEAR(past[0].points.back().position.x(), 0.5, 1e-6);
}

TEST(Guides, OfTwoSideBySideOneIsFollowed) {
  const Mesh plate = sample_shape("plate");
  const double edge = 0.05;
  const auto beside = [&](double distance) {
    const std::vector<Guide> guides{segment({-0.3, 0, 0}, {0.3, 0, 0}),
                                    segment({-0.3, distance, 0}, {0.3, distance, 0})};
    return trace_guides(plate, guides, {}, edge, 1).runs.size();
  };
  EXPECT_EQ(beside(0.3 * edge), 1u);
  EXPECT_EQ(beside(2 * edge), 2u);
}

TEST(Guides, BreakAtTheirCorners) {
  const Guide square{{{0.3, 0, 0}, {0, 0.3, 0}, {-0.3, 0, 0}, {0, -0.3, 0}}, true, 1};
  const auto runs = trace_guides(sample_shape("plate"), std::vector{square}, {}, 0.05, 1).runs;
  ASSERT_EQ(runs.size(), 4u);
  for (const GuideRun& run : runs) {
    EXPECT_FALSE(run.closed);
    const Point side = run.points.back().position - run.points.front().position;
    EXPECT_NEAR(side.norm(), std::sqrt(0.18), 1e-5);
  }
}

TEST(Guides, OffTheSurfaceAreRefusedOrCut) {
  RemeshOptions options;
  options.face_count = 500;
  const Mesh plate = sample_shape("plate");
  options.guides = {segment({0, 0, 3}, {0.2, 0, 3})};
  try {
    remesh(plate, options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("guide 1 lies off the surface, 3.0"),
              std::string::npos)
        << error.what();
  }
  options.guides = {segment({0, 0, 0}, {0, 0, 0})};
  EXPECT_THROW(remesh(plate, options), Error);
  options.guides = {segment({0, 0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0, 0})};
  EXPECT_THROW(remesh(plate, options), Error);
  options.guides = {segment({0, 0, 0}, {0.2, 0, 0})};
  options.guides[0].strength = 1.5f;
  EXPECT_THROW(remesh(plate, options), Error);
  // The part that lies on it is followed.
  options.guides = {{{{-0.3, 0.02, 0}, {0.3, 0.02, 0}, {0.3, 0.02, 2}}}};
  const RemeshResult result = remesh(plate, options);
  ASSERT_EQ(result.report.notes.size(), 1u);
  EXPECT_EQ(result.report.notes[0], "left out parts of 1 guide, which are far from the surface");
  EXPECT_GE(made::followed({segment({-0.3, 0.02, 0}, {0.3, 0.02, 0})}, result.mesh), 0.95);
}

/// The mean angle between crosses and a direction, near the line through the origin along it.
double deviation(const Fields& fields, const Point& along, double near) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < fields.surface.positions.size(); ++i) {
    const Point p = fields.surface.positions[i].cast<double>();
    if ((p - along * along.dot(p)).norm() > near || std::abs(along.dot(p)) > 0.3) continue;
    const double cosine = fields.orientation.directions[i].cast<double>().dot(along);
    const double angle = std::acos(std::clamp(std::abs(cosine), 0.0, 1.0));
    sum += std::min(angle, pi / 2 - angle);
    ++count;
  }
  return sum / count * 180 / pi;
}

/// Those of a strength below one turn the crosses around them, and so do all of a cloud's.
TEST(Guides, DrawTheFields) {
  const Point along = Point(1, 1, 0).normalized();
  RemeshOptions options;
  options.face_count = 1000;
  const Mesh plate = sample_shape("plate");
  Mesh cloud = plate;
  cloud.faces.clear();
  cloud.normals.assign(cloud.positions.size(), Vec3::UnitZ());
  const auto turned = [&](const Mesh& input) {
    return deviation(remesh(input, options).fields, along, 0.04);
  };
  EXPECT_GT(turned(plate), 30);
  options.guides = {segment(-0.4 * along, 0.4 * along)};
  for (const float strength : {0.3f, 0.8f}) {
    options.guides[0].strength = strength;
    EXPECT_LT(turned(plate), 10);
  }
  options.guides[0].strength = 1;
  EXPECT_LT(turned(cloud), 10);
  options.graph.nodes = GraphNodes::faces;
  EXPECT_LT(turned(plate), 10);
}

TEST(Guides, OnEitherSideOfASymmetricModelAreFollowedOnBoth) {
  RemeshOptions options;
  options.face_count = 2000;
  options.symmetry.axes = {true, false, false};
  const Guide left = made::guide_along([](double t) -> Point {
    const double a = pi * (0.55 + 0.35 * t);
    return {std::cos(a) * std::cos(0.5), std::sin(a), std::cos(a) * std::sin(0.5)};
  });
  Guide right = left;
  for (Point& p : right.points) p.x() = -p.x();
  options.guides = {left};
  const Mesh output = remesh(sample_shape("sphere"), options).mesh;
  EXPECT_GE(made::followed({left}, output), 0.95);
  EXPECT_GE(made::followed({right}, output), 0.95);
}

TEST(Guides, ResultsDoNotDependOnTheNumberOfThreads) {
  RemeshOptions options;
  options.face_count = 2000;
  options.guides = {spiral(), made::arc({0.5, 1, 0}, 0, 5)};
  const Mesh sphere = sample_shape("sphere");
  const Mesh one = remesh(sphere, options, Context(1)).mesh;
  const Mesh many = remesh(sphere, options, Context(7)).mesh;
  EXPECT_EQ(one.positions, many.positions);
  EXPECT_TRUE(std::ranges::equal(one.faces.corners(), many.faces.corners()));
}

}  // namespace
}  // namespace meshgrain
