#pragma once

#include <algorithm>
#include <cmath>

namespace meshgrain {

/// How many faces to ask a lattice for so that it has a wanted number of them. A single attempt may
/// be off by as much as a row of cells, so that all attempts count; and where creases lie close, a
/// coarser lattice has less than in proportion fewer faces.
class CountSearch {
 public:
  /// What is asked for, as the logarithm of its share of what was at first.
  double asked() const { return asked_; }

  /// Whether there are too many however few are asked for.
  bool is_in_vain() const { return is_in_vain_; }

  /// An attempt with what was asked for has so many times the faces that are wanted; the next one
  /// is to have `aim` times as many as are wanted.
  void go_on(double ratio, double aim) {
    constexpr double least_ratio = 1e-2;  // there may be no faces at all
    const double got = std::log(std::max(ratio, least_ratio));
    ++count_;
    sum_asked_ += asked_;
    sum_got_ += got;
    sum_squares_ += asked_ * asked_;
    sum_products_ += asked_ * got;
    // A line through all attempts, by least squares; its slope is taken to be 1 until attempts that
    // lie further apart than chance brings about say otherwise.
    constexpr double chance = 0.2 * 0.2, least_slope = 0.3;
    const double mean_asked = sum_asked_ / count_, mean_got = sum_got_ / count_;
    const double squares = sum_squares_ - count_ * mean_asked * mean_asked;
    const double products = sum_products_ - count_ * mean_asked * mean_got;
    const double slope = std::clamp((products + chance) / (squares + chance), least_slope, 1.0);
    // Fewer are no answer to far fewer: there are as many as lines and holes need.
    constexpr double far = 1.3 * 1.3 / 2, hardly = 0.1;
    is_in_vain_ = got > 0 && count_ > 2 && squares > far && products < hardly * squares;
    constexpr double most_at_once = 1.4;
    const double next = mean_asked + (std::log(aim) - mean_got) / slope;
    asked_ = std::clamp(next, asked_ - most_at_once, asked_ + most_at_once);
  }

 private:
  bool is_in_vain_ = false;
  double asked_ = 0;
  double count_ = 0, sum_asked_ = 0, sum_got_ = 0, sum_squares_ = 0, sum_products_ = 0;
};

}  // namespace meshgrain
