#pragma once

#include <cstdint>
#include <vector>

#include "meshgrain/extract.h"
#include "meshgrain/features.h"

namespace meshgrain {

/// Which vertices of a mesh are held by feature lines, and where on them they are.
class Rails {
 public:
  /// Vertices of edges that follow a line slide along it; those at corners stay there. A vertex of
  /// the mesh's border that follows none slides along the line of its node if there is one, else
  /// it stays where it is.
  Rails(const Extraction& extraction, const FeatureLines& lines,
        const Context& context = Context(1));

  bool is_fixed(std::size_t v) const { return segment_[v] == stays; }
  bool is_free(std::size_t v) const { return segment_[v] == no_index; }
  /// Along a line.
  bool slides(std::size_t v) const { return !is_fixed(v) && !is_free(v); }

  /// Whether pieces of a surface that is not manifold meet there.
  bool is_meeting(std::size_t v) const { return !meets_.empty() && meets_[v] != 0; }

  /// The place on its line nearest to `p` that a vertex has; it remembers where that is.
  Vec3 project(const Vec3& p, std::size_t v);

  /// Lets a vertex go. Returns whether it was on a line; `node` then gets a vertex there.
  bool release(std::size_t v, Index& node);

  /// Where on its line a vertex is, to go back to: the segment, by the place in lines().vertices
  /// where that begins.
  Index place(std::size_t v) const { return segment_[v]; }
  void set_place(std::size_t v, Index place) { segment_[v] = place; }
  const FeatureLines& lines() const { return lines_; }
  /// A vertex of the surface there, or no_index.
  Index node(Index place) const {
    return place < lines_.vertices.size() ? lines_.vertices[place] : no_index;
  }

 private:
  static constexpr Index stays = no_index - 1;

  /// `entry`: the place of v's node in lines_.vertices, or no_index; `p`: where v is.
  void put_on_line(Index v, Index line, Index entry, const Vec3& p);

  const FeatureLines& lines_;
  // For each vertex its place; `stays`, or no_index.
  std::vector<Index> segment_;
  std::vector<Index> line_;
  std::vector<std::uint8_t> meets_;  // empty: nowhere
};

}  // namespace meshgrain
