#pragma once

#include <span>
#include <vector>

#include "extract/extraction_map.h"

namespace meshgrain {

/// Gives the faces along a border whose vertices stay the edges that they need.
class BorderFaces {
 public:
  enum class Kind { triangles, quads, only_quads };

  BorderFaces(ExtractionMap& mesh, Kind kind) : mesh_(mesh), map_(mesh.map), kind_(kind) {}

  /// Splits faces that have too many corners, or a straight angle that nothing can bend.
  void mend();

  /// Divides pairs of neighbouring faces near the border anew where that makes better ones.
  /// Returns whether any were.
  bool improve();

 private:
  bool is_straight(Index h) const;
  bool needs_split(const std::vector<Index>& orbit) const;
  Index open(Index h);
  void split(Index h);
  void find_near();
  bool is_near(const std::vector<Index>& orbit) const;
  bool divide_anew(Index h);
  bool divide_around_hub(Index h, const std::vector<Index>& both);
  std::vector<std::vector<std::size_t>> best_parts(const std::vector<Index>& orbit) const;
  void cut_in_two(const std::vector<Index>& orbit);
  double part_cost(const std::vector<Index>& orbit, std::span<const std::size_t> part) const;
  void add_chords(const std::vector<Index>& orbit,
                  const std::vector<std::vector<std::size_t>>& parts, std::size_t& next,
                  Index last);
  Index add_edge(Index a, Index b);
  void add_hub(const std::vector<Index>& orbit);

  ExtractionMap& mesh_;
  PolygonMap& map_;
  Kind kind_;
  std::vector<std::uint8_t> near_;  // of each vertex, whether it has a face on the border
};

}  // namespace meshgrain
