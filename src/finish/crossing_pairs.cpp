#include "finish/crossing_pairs.h"

#include <algorithm>
#include <cstdint>

#include "measure/crossings.h"

namespace meshgrain {

CrossingPairs::CrossingPairs(const Mesh& mesh, const Context& context)
    : mesh_(mesh),
      context_(context),
      positions_(mesh.positions),
      pairs_(find_crossings(mesh, context)) {}

bool CrossingPairs::update() {
  if (mesh_.positions == positions_) return false;
  const auto has_moved = [&](Index v) { return mesh_.positions[v] != positions_[v]; };
  std::vector<std::uint8_t> moved(mesh_.faces.size());
  for (Index f = 0; f < moved.size(); ++f)
    moved[f] = std::ranges::any_of(mesh_.faces[f], has_moved);
  std::erase_if(pairs_, [&](const auto& pair) { return (moved[pair[0]] | moved[pair[1]]) != 0; });
  const auto found = find_crossings_of(mesh_, moved, context_);
  const auto middle = pairs_.insert(pairs_.end(), found.begin(), found.end());
  std::inplace_merge(pairs_.begin(), middle, pairs_.end());
  positions_ = mesh_.positions;
  return true;
}

}  // namespace meshgrain
