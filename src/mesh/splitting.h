#pragma once

#include <array>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// A triangle mesh whose edges and faces can be split one by one. Normals, values and marked edges
/// follow. Its memory beside the mesh's own grows with what is split.
class Splitting {
 public:
  Splitting(Mesh& mesh, const Context& context);

  /// The faces around a vertex.
  std::vector<Index> around(Index v) const;
  std::span<const Index> face(Index f) const { return std::as_const(mesh_.faces)[f]; }
  Eigen::Vector3d position(Index v) const { return mesh_.positions[v].cast<double>(); }

  /// The faces that lie where face f of the mesh was at first.
  std::vector<Index> parts(Index f) const;

  /// Puts a vertex onto an edge, so far on its way from a to b.
  Index split_edge(Index a, Index b, double share);

  /// Puts a vertex into a face, at these barycentric coordinates.
  Index split_face(Index f, const std::array<double, 3>& weights);

 private:
  std::vector<Index>& changed(Index v);
  Index add_vertex(const std::array<Index, 3>& of, const std::array<double, 3>& weights);
  Index copy_face(Index f);
  void replace(Index f, Index from, Index to);

  Mesh& mesh_;
  VertexFaces around_;
  std::size_t faces_;                                      // at first
  std::unordered_map<Index, std::vector<Index>> changed_;  // instead of around_
  std::unordered_map<Index, Index> origin_;                // of each face that was added
  std::unordered_map<Index, std::vector<Index>> parts_;    // of each face that was split
  std::map<std::array<Index, 2>, std::size_t> marked_;     // places in Mesh::marked_edges
};

}  // namespace meshgrain
