#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "meshgrain/mesh.h"
#include "util/hash.h"

namespace meshgrain {

/// Calls `visit(point)` for points along a segment, no farther apart than that; for one at least.
template <typename Visit>
void for_samples(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double apart,
                 const Visit& visit) {
  const Eigen::Vector3d along = to - from;
  const double count = std::max(1.0, std::ceil(along.norm() / apart));
  for (double k = 0.5; k < count; ++k) visit(Eigen::Vector3d(from + (k / count) * along));
}

/// Points along lines, found again by their place.
class LineSamples {
 public:
  struct Sample {
    Eigen::Vector3d position;
    Eigen::Vector3d direction;  ///< Of the line: a unit vector, of either sign.
    Eigen::Vector3d normal;     ///< Of the surface, or zero.
    Index line, number;         ///< Which of its line's samples it is.
  };

  /// `reach`: the largest distance that will be asked for. `most`: in a cube as wide as that;
  /// others there are left out.
  explicit LineSamples(double reach, std::size_t most = std::numeric_limits<std::size_t>::max())
      : reach_(reach), most_(most) {}

  void add(const Sample& sample) {
    std::vector<Index>& in_cell = cells_[key(cell(sample.position))];
    if (in_cell.size() >= most_) return;
    in_cell.push_back(static_cast<Index>(samples_.size()));
    samples_.push_back(sample);
  }

  /// Calls `visit(sample, distance)` for all samples within `radius`, no more than the reach.
  template <typename Visit>
  void for_near(const Eigen::Vector3d& p, double radius, const Visit& visit) const {
    any_near(p, radius, [&](const Sample& sample, double distance) {
      visit(sample, distance);
      return false;
    });
  }

  /// Whether `test(sample, distance)` holds of any of these.
  template <typename Test>
  bool any_near(const Eigen::Vector3d& p, double radius, const Test& test) const {
    const Cell center = cell(p);
    for (std::int64_t x = -1; x <= 1; ++x) {
      for (std::int64_t y = -1; y <= 1; ++y) {
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto found = cells_.find(key(center + Cell(x, y, z)));
          if (found == cells_.end()) continue;
          for (const Index s : found->second) {
            const double distance = (samples_[s].position - p).norm();
            if (distance <= radius && test(samples_[s], distance)) return true;
          }
        }
      }
    }
    return false;
  }

 private:
  using Cell = Eigen::Matrix<std::int64_t, 3, 1>;

  Cell cell(const Eigen::Vector3d& p) const {
    return (p / reach_).array().floor().cast<std::int64_t>();
  }
  // Cells that share a key only cost time: distances are looked at anyway.
  static std::uint64_t key(const Cell& c) {
    return hash64(static_cast<std::uint64_t>(c[0]),
                  hash64(static_cast<std::uint64_t>(c[1]), static_cast<std::uint64_t>(c[2])));
  }

  double reach_;
  std::size_t most_;
  std::vector<Sample> samples_;
  std::unordered_map<std::uint64_t, std::vector<Index>> cells_;
};

}  // namespace meshgrain
