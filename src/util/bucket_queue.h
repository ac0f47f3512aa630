#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace meshgrain {

/// A queue for shortest paths (Dial 1969): whatever costs about the same is in one bucket, and
/// comes in no order. Where no step costs less than the width of a bucket, nothing that has come
/// gets any cheaper; else it may have to be looked at again.
class BucketQueue {
 public:
  explicit BucketQueue(float width) : width_(width) { clear(); }

  struct Entry {
    float cost;
    std::uint32_t item;
  };

  void clear() {
    first_.fill(none);
    nodes_.clear();
    later_.clear();
    start_ = 0;
    lowest_ = count;
  }

  void push(float cost, std::uint32_t item) {
    const float place = (cost - start_) / width_;
    if (place >= static_cast<float>(count)) {
      later_.push_back({cost, item});
      return;
    }
    // Also what is not finite, once it is all that is left.
    const auto bucket = static_cast<std::size_t>(std::max(0.0f, place));
    lowest_ = std::min(lowest_, bucket);
    nodes_.push_back({{cost, item}, first_[bucket]});
    first_[bucket] = static_cast<std::uint32_t>(nodes_.size() - 1);
  }

  /// Moves on to the next entry. Returns whether there is one.
  bool find() {
    while (lowest_ < count && first_[lowest_] == none) ++lowest_;
    if (lowest_ < count) return true;
    if (later_.empty()) return false;
    nodes_.clear();
    const auto nearest = std::ranges::min_element(later_, {}, &Entry::cost);
    start_ = nearest->cost;
    for (const Entry& entry : std::exchange(later_, {})) push(entry.cost, entry.item);
    return true;
  }
  /// No entry that is left costs less than that, but for rounding.
  float least() const { return start_ + static_cast<float>(lowest_) * width_; }
  Entry pop() {
    const Node& node = nodes_[first_[lowest_]];
    first_[lowest_] = node.next;
    return node.entry;
  }

 private:
  struct Node {
    Entry entry;
    std::uint32_t next;
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  static constexpr std::size_t count = 512;

  float width_;
  float start_ = 0;                         // the least cost of the first bucket
  std::array<std::uint32_t, count> first_;  // of each bucket: the last node that was pushed
  std::size_t lowest_ = count;              // no bucket below has entries
  std::vector<Node> nodes_;
  std::vector<Entry> later_;  // beyond the buckets
};

}  // namespace meshgrain
