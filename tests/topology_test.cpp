#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "same_topology.h"

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

}  // namespace
}  // namespace meshgrain
