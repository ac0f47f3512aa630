#pragma once

#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/extract.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The border and the creases of a triangle mesh as polylines, to slide along.
class FeatureLines {
 public:
  /// `crease_degrees`: the least angle between the normals of a crease's faces; < 0: borders only.
  FeatureLines(const Mesh& surface, double crease_degrees, const Context& context);

  bool empty() const { return vertices_.empty(); }
  std::span<const Index> vertices() const { return vertices_; }
  bool contains(Index vertex) const {
    return !offsets_.empty() && offsets_[vertex] < offsets_[vertex + 1];
  }
  /// A place where a line turns by more than 40 degrees, ends, or meets others.
  bool is_corner(Index vertex) const { return corner_[vertex]; }

  /// The nearest point of the lines, walking from `seed`, one of their vertices.
  Vec3 project(const Vec3& p, Index& seed) const;

 private:
  std::span<const Index> neighbors(Index vertex) const {
    return {neighbors_.data() + offsets_[vertex], offsets_[vertex + 1] - offsets_[vertex]};
  }

  const Mesh& surface_;
  std::vector<Index> vertices_;
  std::vector<Index> offsets_, neighbors_;  // for each vertex of the surface, those along its lines
  std::vector<std::uint8_t> corner_;
};

/// Which vertices of a mesh are held by feature lines.
struct Rails {
  std::vector<Index> seed;          // where on the lines, or no_index
  std::vector<std::uint8_t> fixed;  // stays: at the seed, or where it is
};

/// Border vertices slide along the border; vertices on chains of edges that lie on a crease slide
/// along that. The nearest of them takes the place of each corner.
Rails attach_to_lines(const Extraction& extraction, const Mesh& surface, const FeatureLines& lines);

}  // namespace meshgrain
