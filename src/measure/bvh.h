#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "mesh/triangles.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// A tree of bounding boxes over the triangles of a mesh, or over the points of a cloud, for
/// finding the closest point. Built in O(n log n) by halving at the medians; about 60 bytes a
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
  /// The closest point of the surface to `p` nearer than the given squared distance. Of triangles
  /// that are as near, as at a vertex, it is that of the first.
  Hit closest(const Eigen::Vector3d& p,
              double squared_limit = std::numeric_limits<double>::infinity()) const;

 private:
  /// Has up to four children, whose boxes are looked at side by side.
  using Lanes = Eigen::Array4f;
  struct Node {
    std::array<Lanes, 3> low, high;  // of each axis; nothing is near to a child that is not there
    std::array<Index, 4> child;
    std::array<bool, 4> is_item;  // else it is a node
  };

  void build(const std::vector<Vec3>& middles);
  /// Makes a node of some of the items.
  Index build(std::span<Index> items, const std::vector<Vec3>& middles);
  Eigen::AlignedBox3f box_of(Index item) const;
  Eigen::AlignedBox3f box_of(const Node& node) const;
  Eigen::Vector3d closest_of(Index item, const Eigen::Vector3d& p) const;

  const std::vector<Vec3>& positions_;
  std::vector<Triangle> triangles_;  // of a cloud: empty
  std::vector<Node> nodes_;          // the first is the root
};

}  // namespace meshgrain
