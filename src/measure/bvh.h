#pragma once

#include <limits>
#include <vector>

#include "mesh/triangles.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// A tree of bounding boxes over the triangles of a mesh, or over the points of a cloud, for
/// finding the closest point. Built in O(n log n) by halving at the median; about 60 bytes a
/// triangle.
class Bvh {
 public:
  /// Keeps a reference to the mesh's positions.
  explicit Bvh(const Mesh& mesh);
  /// Over some triangles alone. Keeps a reference to the positions.
  Bvh(const std::vector<Vec3>& positions, std::vector<Triangle> triangles);

  /// Empty for a cloud.
  const std::vector<Triangle>& triangles() const { return triangles_; }

  struct Hit {
    double squared_distance;
    Index triangle;         ///< Of triangles(), or a vertex of a cloud; no_index if none.
    Eigen::Vector3d point;  ///< The closest point.
  };
  /// The closest point of the surface to `p` nearer than the given squared distance.
  Hit closest(const Eigen::Vector3d& p,
              double squared_limit = std::numeric_limits<double>::infinity()) const;

 private:
  struct Node {
    Vec3 low, high;
    Index
        first;  ///< First item of a leaf; the right child of an inner node, whose left one is next.
    Index count;  ///< Items of a leaf; 0 in an inner node.
  };

  void build(const std::vector<Vec3>& middles);
  Index build(Index begin, Index end, const std::vector<Vec3>& middles);

  const std::vector<Vec3>& positions_;
  std::vector<Triangle> triangles_;  // of a cloud: empty
  std::vector<Index> items_;         // triangles or vertices, leaf after leaf
  std::vector<Node> nodes_;
};

}  // namespace meshgrain
