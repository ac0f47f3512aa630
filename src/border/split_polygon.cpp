#include "border/split_polygon.h"

#include <limits>

namespace meshgrain {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

class Splitter {
 public:
  Splitter(std::size_t count, const PolygonParts& parts)
      : count_(count), parts_(parts), best_(count * count) {}

  std::vector<std::vector<std::size_t>> run() {
    for (std::size_t length = 2; length < count_; ++length) {
      for (std::size_t i = 0; i + length < count_; ++i) solve(i, i + length);
    }
    std::vector<std::vector<std::size_t>> result;
    if (at(0, count_ - 1).cost < never) collect(0, count_ - 1, result);
    return result;
  }

 private:
  /// What lies between two corners and the chord that joins them.
  struct Best {
    double cost = never;
    std::vector<std::size_t> part;  // the one beside the chord
  };

  Best& at(std::size_t i, std::size_t j) { return best_[i * count_ + j]; }
  double cost(std::size_t i, std::size_t j) { return j == i + 1 ? 0 : at(i, j).cost; }

  void solve(std::size_t i, std::size_t j) {
    if (!(i == 0 && j + 1 == count_) && !parts_.may_join(i, j)) return;
    std::vector<std::size_t> part{i};
    extend(part, j, 0, at(i, j));
  }

  /// Tries all ways to go on from the last corner of a part to j.
  void extend(std::vector<std::size_t>& part, std::size_t j, double behind, Best& best) {
    const std::size_t last = part.back();
    if (part.size() >= 2) {
      const double sum = behind + cost(last, j);
      if (sum < best.cost) {
        part.push_back(j);
        const double all = sum + parts_.cost(part);
        if (all < best.cost) best = {all, part};
        part.pop_back();
      }
    }
    if (part.size() + 2 > parts_.most_corners) return;
    for (std::size_t k = last + 1; k < j; ++k) {
      const double sum = behind + cost(last, k);
      if (!(sum < best.cost)) continue;
      part.push_back(k);
      extend(part, j, sum, best);
      part.pop_back();
    }
  }

  void collect(std::size_t i, std::size_t j, std::vector<std::vector<std::size_t>>& result) {
    const std::vector<std::size_t>& part = at(i, j).part;
    result.push_back(part);
    for (std::size_t k = 0; k + 1 < part.size(); ++k) {
      if (part[k + 1] > part[k] + 1) collect(part[k], part[k + 1], result);
    }
  }

  std::size_t count_;
  const PolygonParts& parts_;
  std::vector<Best> best_;
};

}  // namespace

std::vector<std::vector<std::size_t>> split_polygon(std::size_t count, const PolygonParts& parts) {
  return Splitter(count, parts).run();
}

}  // namespace meshgrain
