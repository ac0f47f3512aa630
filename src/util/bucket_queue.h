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
  explicit BucketQueue(float width) : width_(width) {}

  struct Entry {
    float cost;
    std::uint32_t item;
  };

  void clear() {
    for (; lowest_ < count; ++lowest_) buckets_[lowest_].clear();
    later_.clear();
    start_ = 0;
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
    buckets_[bucket].push_back({cost, item});
  }

  /// Moves on to the next entry. Returns whether there is one.
  bool find() {
    while (lowest_ < count && buckets_[lowest_].empty()) ++lowest_;
    if (lowest_ < count) return true;
    if (later_.empty()) return false;
    const auto nearest = std::ranges::min_element(later_, {}, &Entry::cost);
    start_ = nearest->cost;
    for (const Entry& entry : std::exchange(later_, {})) push(entry.cost, entry.item);
    return true;
  }
  Entry pop() {
    const Entry entry = buckets_[lowest_].back();
    buckets_[lowest_].pop_back();
    return entry;
  }
  /// Takes all that is in the next bucket. Returns whether there was anything.
  bool take_bucket(std::vector<Entry>& entries) {
    entries.clear();
    if (!find()) return false;
    entries.swap(buckets_[lowest_]);
    return true;
  }

 private:
  static constexpr std::size_t count = 512;

  float width_;
  float start_ = 0;  // the least cost of the first bucket
  std::array<std::vector<Entry>, count> buckets_;
  std::size_t lowest_ = count;  // no bucket below has entries
  std::vector<Entry> later_;    // beyond the buckets
};

}  // namespace meshgrain
