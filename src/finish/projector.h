#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/graph.h"

namespace meshgrain {

/// Finds the nearest point of the input by walking over it from a vertex that is known to be near.
/// No tree over the input is needed, and the walk stays on its own side of a thin wall.
class Projector {
 public:
  /// `surface` is a triangle mesh, with the faces `around` its vertices, or the point cloud that
  /// `graph` was built on; all must outlive this.
  Projector(const Mesh& surface, const VertexFaces& around, const Graph& graph)
      : surface_(surface), graph_(graph), around_(around) {}

  const Mesh& surface() const { return surface_; }

  /// The point of the surface nearest to `p`. `seed` is where to start (a vertex of the surface),
  /// and becomes the one where the walk ended.
  Vec3 project(const Vec3& p, Index& seed) const;

  /// A plane that touches the surface.
  struct Plane {
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero();

    Vec3 project(const Vec3& p) const { return p - normal * normal.dot(p - point); }
  };

  /// The plane that touches the surface about where `p` is nearest to it, with a `seed` as for
  /// project(): at the nearest vertex, which is found far sooner than the nearest point.
  Plane touch(const Vec3& p, Index& seed) const;

  /// Asks the memory for what touch() reads of a seed; the neighbours after the node.
  void prefetch_node(Index seed) const;
  void prefetch_neighbors(Index seed) const;

  /// The normal of the surface at a vertex.
  Vec3 normal(Index vertex) const;

  /// The faces of a mesh in and across a box that hang together there with one of the vertices
  /// `from`, increasing, if there are no more than `most`.
  std::optional<std::vector<Index>> faces_in(const Eigen::AlignedBox3f& box,
                                             std::vector<Index> from, std::size_t most) const;

 private:
  /// Goes on to the nearest of the neighbours in the graph, while that is nearer to p.
  void walk_to_nearest(const Vec3& p, Index& seed) const;
  Vec3 nearest_around(const Vec3& p, Index vertex, Index& nearest_corner) const;
  Vec3 project_on_cloud(const Vec3& p, Index& seed) const;

  const Mesh& surface_;
  const Graph& graph_;
  const VertexFaces& around_;
};

}  // namespace meshgrain
