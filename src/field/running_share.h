#pragma once

namespace meshgrain {

/// Of an area-weighted mean over the children of a node, a child at a time: how much of the mean
/// came before each child.
class RunningShare {
 public:
  /// Adds a child; returns the share of those before it (0 for the first).
  float add(float area) {
    const bool first = area_ < 0;
    const float before = first ? 0 : area_;
    area_ = before + area;
    return area_ > 0 ? before / area_ : first ? 0.0f : 0.5f;
  }

 private:
  float area_ = -1;
};

}  // namespace meshgrain
