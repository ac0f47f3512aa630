#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "made_graph.h"
#include "mesh/border.h"
#include "meshgrain/features.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

/// With its vertices along a curve, as the runs of faces need it.
Mesh dense(const char* name, double resolution) {
  Mesh mesh = sample_shape(name, resolution);
  sort_along_curve(mesh);
  return mesh;
}

CoarseEdges times_mean(const Mesh& mesh, double shortest, double longest) {
  const double mean = edge_lengths(mesh).mean;
  return {static_cast<float>(shortest * mean), static_cast<float>(longest * mean)};
}

std::vector<Index> coarsen(Mesh& mesh, const CoarseEdges& edges, std::vector<Index> stay = {},
                           int threads = 2) {
  std::vector<std::uint8_t> stays(mesh.positions.size(), 0);
  for (const Index v : stay) stays[v] = 1;
  return coarsen(mesh, edges, std::move(stays), Context(threads));
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    sum += mesh.positions[face[0]].dot(mesh.positions[face[1]].cross(mesh.positions[face[2]])) / 6;
  }
  return sum;
}

TEST(Coarsen, KeepsTopologyShapeAndPlace) {
  for (const char* name : {"blob", "three-holes", "torus", "plate", "sphere"}) {
    for (const double shortest : {1.3, 3.0, 6.0}) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(shortest));
      const Mesh fine = dense(name, 2);
      const CoarseEdges edges = times_mean(fine, shortest, 2.2 * shortest);
      Mesh coarse = fine;
      coarsen(coarse, edges);
      made::expect_same_topology(mesh_statistics(coarse), mesh_statistics(fine));
      const auto before = static_cast<double>(fine.positions.size());
      EXPECT_LT(static_cast<double>(coarse.positions.size()), before * (shortest < 2 ? 0.7 : 0.25));
      EXPECT_LE(edge_lengths(coarse).max, std::max(double{edges.longest}, edge_lengths(fine).max));
      EXPECT_LT(surface_distance(coarse, fine, 1, 2000).max, 0.2 * edges.longest);
      EXPECT_LT(surface_distance(fine, coarse, 1, 2000).max, 0.2 * edges.longest);
      EXPECT_TRUE(sharp_edges(coarse, 100).empty());  // nothing has folded over
    }
  }
}

/// Where vertices only stayed on the surface, much of it would be cut off.
TEST(Coarsen, KeepsTheVolume) {
  const Mesh fine = dense("sphere", 1);
  for (const double shortest : {2.0, 8.0}) {
    Mesh coarse = fine;
    coarsen(coarse, times_mean(fine, shortest, 2.2 * shortest));
    EXPECT_NEAR(volume(coarse) / volume(fine), 1, 1e-3) << shortest;
  }
}

/// A border, what is flagged, and what is not inside of one surface.
TEST(Coarsen, SomeVerticesKeepTheirPlaces) {
  Mesh fine = dense("plate", 3);
  std::vector<Index> stay;
  for (Index v = 0; v < fine.positions.size(); v += 50) stay.push_back(v);
  // Three faces at one edge.
  fine.positions.push_back(fine.positions[fine.faces[0][0]] + Vec3(0, 0, 0.1f));
  fine.faces.push_back(
      {fine.faces[0][0], fine.faces[0][1], static_cast<Index>(fine.positions.size() - 1)});
  for (const auto& [a, b] : rim_edges(fine)) stay.insert(stay.end(), {a, b});
  fine.values.resize(fine.positions.size());
  for (Index v = 0; v < fine.values.size(); ++v) fine.values[v] = static_cast<float>(v);
  Mesh coarse = fine;
  const std::vector<Index> kept = coarsen(coarse, times_mean(fine, 3, 6), stay);
  ASSERT_EQ(kept.size(), coarse.positions.size());
  EXPECT_TRUE(std::ranges::is_sorted(kept));
  EXPECT_LT(kept.size(), fine.positions.size() / 3);
  for (const Index v : stay) {
    const auto at = std::ranges::lower_bound(kept, v);
    ASSERT_TRUE(at != kept.end() && *at == v);
    EXPECT_EQ(coarse.positions[static_cast<std::size_t>(at - kept.begin())], fine.positions[v]);
  }
  for (std::size_t k = 0; k < kept.size(); ++k) {
    EXPECT_EQ(coarse.values[k], static_cast<float>(kept[k]));
  }
  EXPECT_EQ(rim_edges(coarse).size(), rim_edges(fine).size());
}

/// Of triangles that are not joined none can go.
TEST(Coarsen, SoupStaysAsItIs) {
  const Mesh blob = sample_shape("blob", 1);
  Mesh soup;
  for (const Index v : blob.faces.corners()) {
    soup.positions.push_back(blob.positions[v]);
    const auto last = static_cast<Index>(soup.positions.size() - 1);
    if (last % 3 == 2) soup.faces.push_back({last - 2, last - 1, last});
  }
  Mesh coarse = soup;
  EXPECT_EQ(coarsen(coarse, times_mean(soup, 3, 6)).size(), soup.positions.size());
  EXPECT_EQ(coarse.positions, soup.positions);
  EXPECT_EQ(coarse.faces.size(), soup.faces.size());
}

TEST(Coarsen, AnyNumberOfThreadsGivesTheSame) {
  const Mesh fine = dense("blob", 5);
  ASSERT_GT(fine.faces.size(), 3 * 32768u);  // several runs
  Mesh one = fine;
  coarsen(one, times_mean(fine, 4, 8), {}, 1);
  for (const int threads : {2, 3}) {
    Mesh many = fine;
    coarsen(many, times_mean(fine, 4, 8), {}, threads);
    EXPECT_EQ(many.positions, one.positions);
    EXPECT_TRUE(std::ranges::equal(many.faces.corners(), one.faces.corners()));
  }
}

/// What the fields live on has no more vertices than the faces need, and the mesh none the worse.
TEST(Coarsen, LargeInputsAreRemeshedAsWell) {
  const Mesh fine = sample_shape("blob", 2);
  for (const OutputFaces faces :
       {OutputFaces::quads, OutputFaces::quad_dominant, OutputFaces::triangles}) {
    SCOPED_TRACE(static_cast<int>(faces));
    RemeshOptions options;
    options.faces = faces;
    options.face_count = 1000;
    const RemeshResult coarse = remesh(fine, options);
    options.coarsen = false;
    const RemeshResult whole = remesh(fine, options);
    EXPECT_LT(coarse.report.nodes, whole.report.nodes / 2);
    const MeshStatistics s = mesh_statistics(coarse.mesh), w = mesh_statistics(whole.mesh);
    made::expect_same_topology(s, mesh_statistics(fine));
    EXPECT_LT(s.area_sigma, 1.2 * w.area_sigma);
    EXPECT_LT(s.angle_sigma, 1.2 * w.angle_sigma);
    EXPECT_LT(surface_distance(coarse.mesh, fine, 1, 20000).mean,
              1.1 * surface_distance(whole.mesh, fine, 1, 20000).mean);
  }
}

/// Creases are found where the surface is as it was, and followed as before.
TEST(Coarsen, CreasesAreKept) {
  const Mesh fine = sample_shape("bracket", 2);
  RemeshOptions options;
  options.face_count = 1000;
  const RemeshResult result = remesh(fine, options);
  EXPECT_LT(result.report.nodes, fine.positions.size() / 2);
  const KeptLines kept = kept_lines(fine, result.mesh);
  EXPECT_GE(kept.creases.value(), 0.999);
  EXPECT_EQ(kept.corners_kept, kept.corners);
}

}  // namespace
}  // namespace meshgrain
