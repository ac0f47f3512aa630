#include "mesh/box_cells.h"

#include <algorithm>

namespace meshgrain {

BoxCells::BoxCells(std::span<const Eigen::AlignedBox3f> boxes, float width) {
  for (const auto& box : boxes) all_.extend(box);
  if (all_.isEmpty()) return;
  constexpr float most = 128;  // cells along a side
  low_ = all_.min();
  width_ = std::max({width, all_.sizes().maxCoeff() / most, 1e-30f});
  counts_ = cell(all_.max()) + 1;
  touched_.assign(static_cast<std::size_t>(counts_[0]) * static_cast<std::size_t>(counts_[1]) *
                      static_cast<std::size_t>(counts_[2]),
                  false);
  for (const auto& box : boxes) {
    for_cells(box, [&](const Cell& at) {
      touched_[place(at)] = true;
      return true;
    });
  }
}

/// While body(cell) returns true.
template <typename Body>
void BoxCells::for_cells(const Eigen::AlignedBox3f& box, const Body& body) const {
  const Eigen::AlignedBox3f inside = box.intersection(all_);
  if (inside.isEmpty()) return;
  const Cell low = cell(inside.min()), high = cell(inside.max());
  for (int z = low[2]; z <= high[2]; ++z) {
    for (int y = low[1]; y <= high[1]; ++y) {
      for (int x = low[0]; x <= high[0]; ++x) {
        if (!body(Cell(x, y, z))) return;
      }
    }
  }
}

bool BoxCells::contains(const Vec3& p) const {
  return all_.contains(p) && touched_[place(cell(p))];
}

bool BoxCells::touches(const Eigen::AlignedBox3f& box) const {
  bool found = false;
  for_cells(box, [&](const Cell& at) {
    found = touched_[place(at)];
    return !found;
  });
  return found;
}

}  // namespace meshgrain
