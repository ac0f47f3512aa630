#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "meshgrain/uninitialized.h"

namespace meshgrain {

using Vec3 = Eigen::Vector3f;
using Index = std::uint32_t;
inline constexpr Index no_index = ~Index{0};

/// Polygons as runs of vertex indices. While all have the same number of corners only the indices
/// are stored; the first polygon that differs adds one offset a polygon.
class Faces {
 public:
  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }

  /// The corners of face `f`, in order around it.
  std::span<const Index> operator[](std::size_t f) const {
    return {corners_.data() + first(f), degree(f)};
  }
  std::span<Index> operator[](std::size_t f) { return {corners_.data() + first(f), degree(f)}; }

  std::size_t degree(std::size_t f) const {
    return starts_.empty() ? degree_ : starts_[f + 1] - starts_[f];
  }
  /// Position of the first corner of face `f` within corners().
  std::size_t first(std::size_t f) const { return starts_.empty() ? f * degree_ : starts_[f]; }

  /// The common number of corners, or 0 if the faces differ (or there are none).
  std::size_t uniform_degree() const { return starts_.empty() ? degree_ : 0; }

  /// All corners, face after face.
  std::span<const Index> corners() const { return corners_; }
  std::span<Index> corners() { return corners_; }

  void push_back(std::span<const Index> face);
  void push_back(std::initializer_list<Index> face) {
    push_back(std::span<const Index>(face.begin(), face.size()));
  }
  /// Many faces of `degree` corners each.
  void append(std::span<const Index> corners, std::size_t degree);
  void reserve(std::size_t faces, std::size_t corners);
  void clear() { *this = Faces(); }

  /// `count` faces of `degree` corners each, their corners to be filled in by the caller.
  static Faces uniform(std::size_t count, std::size_t degree);

 private:
  UninitializedVector<Index> corners_;
  std::vector<std::size_t> starts_;  // count_ + 1 offsets, or empty while the degree is uniform
  std::size_t count_ = 0;
  std::size_t degree_ = 0;
};

/// A polygon mesh, or a point cloud if it has no faces.
struct Mesh {
  std::vector<Vec3> positions;  ///< In units of the input, relative to `origin`.
  Faces faces;                  ///< Empty for a point cloud.
  std::vector<Vec3> normals;    ///< One unit vector a vertex, or empty.
  std::vector<float> values;    ///< One number a vertex (ReadOptions::value_name), or empty.
  /// Edges of faces, as the vertices at their ends, that find_features() is to make lines of. In
  /// any order; what changes the mesh carries them along.
  std::vector<std::array<Index, 2>> marked_edges;
  /// Added to every position when the mesh is written: keeps single precision exact enough for
  /// surfaces far from zero (surveys, scans in map coordinates).
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();

  bool is_point_cloud() const { return faces.empty(); }
};

}  // namespace meshgrain
