#include "meshgrain/graph.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "made_graph.h"
#include "meshgrain/error.h"
#include "meshgrain/normals.h"
#include "meshgrain/shapes.h"
#include "meshgrain/surface.h"
#include "util/angle.h"

namespace meshgrain {
namespace {

std::vector<std::set<Index>> edges_of(const Mesh& mesh) {
  std::vector<std::set<Index>> around(mesh.positions.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Index a : mesh.faces[f]) {
      for (const Index b : mesh.faces[f]) {
        if (a != b) around[a].insert(b);
      }
    }
  }
  return around;
}

/// Sorted neighbours without repeats or loops, every edge from both ends with the same positive
/// weight.
void expect_sound(const Graph& graph) {
  ASSERT_EQ(graph.offsets.size(), graph.size() + 1);
  ASSERT_EQ(graph.normals.size(), graph.size());
  ASSERT_EQ(graph.areas.size(), graph.size());
  if (!graph.weights.empty()) {
    ASSERT_EQ(graph.weights.size(), graph.neighbors.size());
  }
  for (Index i = 0; i < graph.size(); ++i) {
    EXPECT_GT(graph.areas[i], 0);
    EXPECT_NEAR(graph.normals[i].norm(), 1, 1e-5);
    const auto around = graph.neighbors_of(i);
    for (std::size_t k = 0; k < around.size(); ++k) {
      ASSERT_LT(around[k], graph.size());
      EXPECT_NE(around[k], i);
      if (k > 0) {
        EXPECT_LT(around[k - 1], around[k]);
      }
      const Index j = around[k];
      const std::size_t back = graph.entry(j, i);
      ASSERT_LT(back, graph.offsets[j + 1]);
      ASSERT_EQ(graph.neighbors[back], i);
      const float weight = graph.weight(graph.offsets[i] + k);
      EXPECT_GT(weight, 0);
      EXPECT_NEAR(weight, graph.weight(back), 1e-5f * weight);
    }
  }
}

double total_area(const Graph& graph) {
  double sum = 0;
  for (const float a : graph.areas) sum += a;
  return sum;
}

TEST(VertexGraph, HasTheEdgesAndTheAreaOfTheMesh) {
  for (const char* name : {"bracket", "sphere", "plate", "three-holes"}) {
    SCOPED_TRACE(name);
    const Mesh mesh = made::shaken(sample_shape(name, 0.4), 0.01f);
    for (const GraphWeights weights : {GraphWeights::uniform, GraphWeights::geometric}) {
      GraphOptions options;
      options.weights = weights;
      const Graph graph = build_graph(mesh, options);
      expect_sound(graph);
      EXPECT_EQ(graph.weights.empty(), weights == GraphWeights::uniform);
      const auto expected = edges_of(mesh);
      for (Index v = 0; v < graph.size(); ++v) {
        EXPECT_TRUE(std::ranges::equal(graph.neighbors_of(v), expected[v]));
      }
      EXPECT_NEAR(total_area(graph), surface_area(mesh), 1e-4 * surface_area(mesh));
    }
  }
}

TEST(QuickAngle, IsTheArcTangent) {
  for (int k = 0; k <= 1000; ++k) {
    const double angle = std::numbers::pi * k / 1000, scale = std::exp(angle - 1);
    const double sine = scale * std::abs(std::sin(angle)), cosine = scale * std::cos(angle);
    EXPECT_NEAR(quick_angle(sine, cosine), std::atan2(sine, cosine), 1e-15 * (1 + angle)) << k;
  }
  EXPECT_EQ(quick_angle(0, 0), 0);
  EXPECT_EQ(quick_angle(0, -1), std::numbers::pi);
}

TEST(VertexGraph, NormalsAreThoseOfTheSurface) {
  Mesh mesh = sample_shape("bracket", 1);
  // Faces without a normal, and a vertex between such alone.
  const auto count = static_cast<Index>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), 3, mesh.positions[0]);
  mesh.faces.push_back({0, count, count + 1});
  mesh.faces.push_back({count, count + 2, count + 1});
  const Graph graph = build_graph(mesh);
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (Index v = 0; v < graph.size(); ++v) {
    EXPECT_LT((graph.normals[v] - normals[v]).norm(), 1e-6f) << v;
  }
  EXPECT_NEAR(total_area(graph), surface_area(mesh), 1e-5 * surface_area(mesh));
}

/// Two right triangles make a square: its diagonal's cotangents are those of right angles.
TEST(VertexGraph, WeightsAreCotangents) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.faces.push_back({0, 1, 2});
  mesh.faces.push_back({0, 2, 3});
  GraphOptions options;
  options.weights = GraphWeights::geometric;
  const Graph graph = build_graph(mesh, options);
  EXPECT_NEAR(graph.weight(graph.entry(0, 1)), 0.5, 1e-6);
  EXPECT_NEAR(graph.weight(graph.entry(0, 2)), 0.01, 1e-6);  // nothing, but positive
  for (const float area : graph.areas) EXPECT_NEAR(area, 0.25, 1e-6);
}

TEST(VertexGraph, CreaseNormalsAreThoseOfFaces) {
  const Mesh cube = sample_shape("cube", 0.5);
  GraphOptions options;
  const auto smooth = build_graph(cube, options).normals;
  options.crease_degrees = 30;
  const auto creased = build_graph(cube, options).normals;
  EXPECT_EQ(creased, vertex_normals(cube, 30));
  std::size_t bent = 0;
  for (std::size_t v = 0; v < smooth.size(); ++v) {
    EXPECT_NEAR(creased[v].cwiseAbs().maxCoeff(), 1, 1e-5);
    bent += smooth[v].cwiseAbs().maxCoeff() < 0.95f;
  }
  EXPECT_GT(bent, 8u);
}

/// Three triangles on one edge, and a vertex where two fans meet.
TEST(VertexGraph, NonManifoldEdgesAreOrdinary) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0},  {0, 1, 0},  {0, -1, 0},
                    {0, 0, 1}, {-1, 0, 1}, {-1, 0, -1}};
  mesh.faces.push_back({0, 1, 2});
  mesh.faces.push_back({1, 0, 3});
  mesh.faces.push_back({0, 1, 4});
  mesh.faces.push_back({0, 5, 6});
  const Graph graph = build_graph(mesh);
  expect_sound(graph);
  EXPECT_EQ(graph.neighbors_of(0).size(), 6u);
  EXPECT_EQ(graph.neighbors_of(1).size(), 4u);
  GraphOptions options;
  options.nodes = GraphNodes::faces;
  const Graph faces = build_graph(mesh, options);
  expect_sound(faces);
  EXPECT_EQ(faces.neighbors_of(0).size(), 2u);
  EXPECT_EQ(faces.neighbors_of(3).size(), 0u);
}

TEST(FaceGraph, HasTheFacesAndTheirNeighbours) {
  const Mesh mesh = sample_shape("bracket", 0.4);
  GraphOptions options;
  options.nodes = GraphNodes::faces;
  const Graph graph = build_graph(mesh, options);
  expect_sound(graph);
  ASSERT_EQ(graph.size(), mesh.faces.size());
  EXPECT_NEAR(total_area(graph), surface_area(mesh), 1e-4 * surface_area(mesh));
  for (Index f = 0; f < graph.size(); ++f) {
    const auto face = mesh.faces[f];
    EXPECT_EQ(graph.neighbors_of(f).size(), 3u);
    for (const Index g : graph.neighbors_of(f)) {
      std::size_t shared = 0;
      for (const Index v : mesh.faces[g]) shared += std::ranges::count(face, v) > 0;
      EXPECT_EQ(shared, 2u);
    }
    const Vec3 mean =
        (mesh.positions[face[0]] + mesh.positions[face[1]] + mesh.positions[face[2]]) / 3;
    EXPECT_LT((graph.positions[f] - mean).norm(), 1e-6f);
  }
}

TEST(CloudGraph, HasTheNearestNeighboursFromBothEnds) {
  const made::Sample sample = made::sphere(1500, 1);
  Mesh cloud;
  cloud.positions = sample.points;
  cloud.normals = sample.normals;
  for (const std::size_t k : {6u, 10u}) {
    for (const GraphWeights weights : {GraphWeights::uniform, GraphWeights::geometric}) {
      GraphOptions options;
      options.neighbors = k;
      options.weights = weights;
      const Graph graph = build_graph(cloud, options);
      expect_sound(graph);
      EXPECT_EQ(graph.normals, cloud.normals);
      EXPECT_NEAR(total_area(graph), 4 * std::numbers::pi, 0.15 * 4 * std::numbers::pi);
      for (Index i = 0; i < graph.size(); i += 97) {
        std::vector<std::pair<float, Index>> all;
        for (Index j = 0; j < graph.size(); ++j) {
          if (j != i) all.push_back({(sample.points[j] - sample.points[i]).squaredNorm(), j});
        }
        std::ranges::sort(all);
        const auto around = graph.neighbors_of(i);
        // All that are nearer than the last one (which may have a rival at the same distance).
        for (std::size_t m = 0; m + 1 < k; ++m) {
          if (all[m].first < all[k - 1].first) {
            EXPECT_TRUE(std::ranges::binary_search(around, all[m].second));
          }
        }
        EXPECT_GE(around.size(), k);
      }
    }
  }
}

/// As placeholders are. Those beside them tell which way they look, here inwards.
TEST(CloudGraph, NormalsWithoutDirectionAreEstimated) {
  const made::Sample sample = made::sphere(1500, 1);
  Mesh cloud;
  cloud.positions = sample.points;
  for (const Vec3& n : sample.normals) cloud.normals.push_back(-n);
  for (Index i = 0; i < cloud.normals.size(); i += 3) cloud.normals[i].setZero();
  cloud.normals[1].setConstant(std::numeric_limits<float>::quiet_NaN());
  const Graph graph = build_graph(cloud);
  for (Index i = 0; i < graph.size(); ++i) {
    EXPECT_LT(graph.normals[i].dot(sample.normals[i]), i % 3 == 0 || i == 1 ? -0.9f : -0.999f);
  }
  Mesh without = cloud;
  without.normals.clear();
  std::ranges::fill(cloud.normals, Vec3::Zero());
  EXPECT_EQ(build_graph(cloud).normals, build_graph(without).normals);
}

TEST(Graph, RefusesWhatItCannotUse) {
  Mesh quads;
  quads.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  quads.faces.push_back({0, 1, 2, 3});
  EXPECT_THROW(build_graph(quads), Error);
  Mesh cloud;
  cloud.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  EXPECT_THROW(build_graph(cloud), Error);
}

}  // namespace
}  // namespace meshgrain
