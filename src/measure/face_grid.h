#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"
#include "util/hash.h"

namespace meshgrain {

Eigen::AlignedBox3f face_box(const Mesh& mesh, Index f);

/// Of all faces.
std::vector<Eigen::AlignedBox3f> face_boxes(const Mesh& mesh, const Context& context);

/// The faces of a mesh by the cells of a grid that their boxes touch. Those that would touch very
/// many, as a plate does beside the letters on it, are in coarser grids.
class FaceGrid {
 public:
  FaceGrid(const Mesh& mesh, const Context& context);

  /// Of cells by their hashes, those of the coarser grids last.
  std::size_t buckets() const { return starts_.empty() ? 0 : starts_.size() - 1; }

  /// How often faces touch a cell.
  std::size_t entries() const { return entries_.size(); }

  /// Calls body(f, g), f < g, for pairs of faces of one grid whose boxes meet in a bucket: for each
  /// in one only.
  template <typename Body>
  void for_each_pair(std::size_t bucket, const Body& body) const {
    for (std::size_t e = starts_[bucket]; e < starts_[bucket + 1]; ++e) {
      for (std::size_t o = e + 1; o < starts_[bucket + 1]; ++o) {
        const auto& [cell, f] = entries_[e];
        const auto& [other_cell, g] = entries_[o];
        if (cell == other_cell && meet_first_in(cell, f, g)) body(f, g);
      }
    }
  }

  /// Whether any are in a coarser grid.
  bool has_large_faces() const { return grids_.size() > 1; }

  /// Calls body(f, g), f < g, for the pairs of a face with those of coarser grids than its own
  /// whose boxes meet.
  template <typename Body>
  void for_each_larger(Index f, const Body& body) const {
    for (std::size_t level = level_of(f) + 1; level < grids_.size(); ++level) {
      for_cells(f, level, [&](std::uint64_t cell) {
        const std::size_t bucket = bucket_of(cell, level);
        for (std::size_t e = starts_[bucket]; e < starts_[bucket + 1]; ++e) {
          const auto& [other_cell, g] = entries_[e];
          if (cell == other_cell && meet_first_in(cell, f, g)) body(std::min(f, g), std::max(f, g));
        }
      });
    }
  }

 private:
  using Cell = Eigen::Array<std::uint32_t, 3, 1>;
  struct Entry {
    std::uint64_t cell;
    Index face;
  };
  struct Grid {
    std::size_t first_bucket;
    int bits;  // of the hash
  };
  static constexpr int bits_a_level = 2;  // so many times two wider are the cells of the next grid
  static constexpr int bits_a_place = 20;

  /// Another one for each grid.
  static std::uint64_t key(const Cell& cell, std::size_t level) {
    return (std::uint64_t{level} << (3 * bits_a_place)) |
           (std::uint64_t{cell[0]} << (2 * bits_a_place)) |
           (std::uint64_t{cell[1]} << bits_a_place) | cell[2];
  }

  static Cell at(const Cell& finest, std::size_t level) {
    const auto shift = static_cast<std::uint32_t>(bits_a_level * level);
    return {finest[0] >> shift, finest[1] >> shift, finest[2] >> shift};
  }

  std::size_t level_of(Index f) const { return levels_.empty() ? 0 : levels_[f]; }

  std::size_t bucket_of(std::uint64_t cell, std::size_t level) const {
    const Grid& grid = grids_[level];
    return grid.first_bucket + (hash64(cell) >> (64 - grid.bits));
  }

  /// Calls body(cell) for those of a level that the face's box touches.
  template <typename Body>
  void for_cells(Index f, std::size_t level, const Body& body) const {
    const Cell low = at(lows_[f], level), high = at(highs_[f], level);
    for (auto x = low[0]; x <= high[0]; ++x) {
      for (auto y = low[1]; y <= high[1]; ++y) {
        for (auto z = low[2]; z <= high[2]; ++z) body(key(Cell(x, y, z), level));
      }
    }
  }

  /// Boxes meet in the cell of the higher ones of their low corners, among others.
  bool meet_first_in(std::uint64_t cell, Index f, Index g) const {
    if (!boxes_[f].intersects(boxes_[g])) return false;
    const std::size_t level = cell >> (3 * bits_a_place);
    return cell == key(at(lows_[f].cwiseMax(lows_[g]), level), level);
  }

  std::size_t smallest_level(Index f) const;
  void find_levels(const Context& context);
  void fill();

  std::vector<Eigen::AlignedBox3f> boxes_;
  std::vector<Cell> lows_, highs_;    // the cells of the boxes' corners, in the finest grid
  std::vector<std::uint8_t> levels_;  // of the faces; none if there is one grid only
  std::vector<Grid> grids_;           // ever coarser
  std::vector<std::size_t> starts_;   // of the buckets
  std::vector<Entry> entries_;        // bucket after bucket, by increasing face
};

}  // namespace meshgrain
