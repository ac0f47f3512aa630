#pragma once

#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/graph.h"

namespace meshgrain {

/// Finds the nearest point of the input by walking over it from a vertex that is known to be near.
/// No tree over the input is needed, and the walk stays on its own side of a thin wall.
class Projector {
 public:
  /// `surface` is a triangle mesh, or the point cloud that `graph` was built on; both must outlive
  /// this.
  Projector(const Mesh& surface, const Graph& graph);

  /// The point of the surface nearest to `p`. `seed` is where to start (a vertex of the surface), and
  /// becomes the one where the walk ended.
  Vec3 project(const Vec3& p, Index& seed) const;

  /// The normal of the surface at a vertex.
  Vec3 normal(Index vertex) const;

 private:
  Vec3 nearest_around(const Vec3& p, Index vertex, Index& nearest_corner) const;
  Vec3 project_on_cloud(const Vec3& p, Index& seed) const;

  const Mesh& surface_;
  const Graph& graph_;
  VertexFaces around_;
};

/// The border of a triangle mesh as polylines, to slide along.
class BorderLine {
 public:
  explicit BorderLine(const Mesh& surface, std::span<const std::array<Index, 2>> edges);

  bool empty() const { return border_.empty(); }
  bool contains(Index vertex) const { return neighbors_[vertex][0] != no_index; }
  /// A place where the border turns by more than 40 degrees, or where it does not simply run on.
  bool is_corner(Index vertex) const { return corner_[vertex]; }
  std::span<const Index> vertices() const { return border_; }

  /// Calls `body` for the corners within `distance` of a border vertex, along the border.
  template <typename Body>
  void for_corners_near(Index vertex, float distance, const Body& body) const {
    if (corner_[vertex]) body(vertex);
    for (const Index first : neighbors_[vertex]) {
      float walked = 0;
      Index previous = vertex, current = first;
      while (current != vertex) {
        walked += (surface_.positions[current] - surface_.positions[previous]).norm();
        if (walked > distance) break;
        if (corner_[current]) body(current);
        const auto& around = neighbors_[current];
        const Index next = around[0] == previous ? around[1] : around[0];
        if (next == previous) break;
        previous = current;
        current = next;
      }
    }
  }

  /// The nearest point of the border line, walking from `seed` (a vertex of the border).
  Vec3 project(const Vec3& p, Index& seed) const;

 private:
  const Mesh& surface_;
  std::vector<Index> border_;
  std::vector<std::array<Index, 2>> neighbors_;
  std::vector<std::uint8_t> corner_;
};

}  // namespace meshgrain
