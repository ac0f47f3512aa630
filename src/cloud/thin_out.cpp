#include "cloud/thin_out.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "util/bounding_box.h"
#include "util/collect.h"
#include "util/sum.h"

namespace meshgrain {
namespace {

constexpr int levels = 21;  // of cells, each half as wide as those before: as fine as the curve

/// Level k: how many pairs of points one after the other are in the same cell at levels up to k.
struct Shared : std::array<std::size_t, levels + 1> {
  Shared() { fill(0); }
  Shared operator+(const Shared& other) const {
    Shared sum = *this;
    for (std::size_t k = 0; k < size(); ++k) sum[k] += other[k];
    return sum;
  }
};

class Cells {
 public:
  explicit Cells(const Eigen::AlignedBox3f& box)
      : low_(box.min()),
        side_(std::max(box.sizes().maxCoeff(), 1e-30f)),
        scale_(static_cast<float>((1u << levels) - 1) / side_) {}

  /// Of a cell.
  double side(int level) const { return std::ldexp(double{side_}, -level); }

  /// The last level at which both are in the same cell.
  int shared(const Vec3& p, const Vec3& q) const {
    std::uint32_t differing = 0;
    for (int axis = 0; axis < 3; ++axis) differing |= place(p, axis) ^ place(q, axis);
    return levels - std::bit_width(differing);
  }

 private:
  std::uint32_t place(const Vec3& p, int axis) const {
    return static_cast<std::uint32_t>((p[axis] - low_[axis]) * scale_);
  }

  Vec3 low_;
  float side_;  // of the cell around all
  float scale_;
};

/// The first level where the cells with points are enough.
int level_of(const Cells& cells, const Shared& shared, const CloudDensity& enough) {
  std::size_t count = 1;
  int level = 0;
  while (level < levels &&
         (static_cast<double>(count) < enough.points || cells.side(level) > enough.cell)) {
    count += shared[static_cast<std::size_t>(level++)];
  }
  return level;
}

struct Point {
  Vec3 position, normal;
  float value;
};

/// The means of points that look to one side.
class Means {
 public:
  explicit Means(const Mesh& cloud) : cloud_(cloud) {}

  void add(Index i) {
    const Eigen::Vector3d normal = cloud_.normals.empty()
                                       ? Eigen::Vector3d::Zero()
                                       : Eigen::Vector3d(cloud_.normals[i].cast<double>());
    Sum& sum = sums_[sums_[0].normal.dot(normal) < 0 ? 1 : 0];
    sum.position += cloud_.positions[i].cast<double>();
    sum.normal += normal;
    sum.value += cloud_.values.empty() ? 0.0 : double{cloud_.values[i]};
    sum.count += 1;
  }

  void move_to(std::vector<Point>& points) {
    for (Sum& sum : sums_) {
      if (sum.count > 0) {
        points.push_back({(sum.position / sum.count).cast<float>(),
                          sum.normal.normalized().cast<float>(),
                          static_cast<float>(sum.value / sum.count)});
      }
      sum = {};
    }
  }

 private:
  struct Sum {
    Eigen::Vector3d position = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    double value = 0, count = 0;
  };

  const Mesh& cloud_;
  std::array<Sum, 2> sums_;
};

}  // namespace

bool thin_out(Mesh& cloud, const CloudDensity& enough, const Context& context) {
  constexpr double worthwhile = 2;  // times as many
  const std::vector<Vec3>& points = cloud.positions;
  const std::size_t n = points.size();
  if (n == 0 || static_cast<double>(n) < worthwhile * enough.points) return false;
  const Cells cells(bounding_box(points, context));
  const Shared shared = sum_over_ranges(
      n,
      [&](std::size_t begin, std::size_t end) {
        Shared here;
        for (std::size_t i = std::max<std::size_t>(begin, 1); i < end; ++i) {
          ++here[static_cast<std::size_t>(cells.shared(points[i - 1], points[i]))];
        }
        return here;
      },
      context);
  const int level = level_of(cells, shared, enough);
  const auto begins = [&](std::size_t i) {
    return i == 0 || cells.shared(points[i - 1], points[i]) < level;
  };
  // A range of points does the cells that begin in it.
  const auto find = [&](std::size_t begin, std::size_t end, std::vector<Point>& out) {
    Means means(cloud);
    while (begin < end && !begins(begin)) ++begin;
    if (begin == end) return;
    for (std::size_t i = begin; i < n; ++i) {
      if (i > begin && begins(i)) {
        means.move_to(out);
        if (i >= end) return;
      }
      means.add(static_cast<Index>(i));
    }
    means.move_to(out);
  };
  const auto left = collect<Point>(n, find, context);
  if (static_cast<double>(n) < worthwhile * static_cast<double>(left.size())) return false;

  const bool has_normals = !cloud.normals.empty(), has_values = !cloud.values.empty();
  cloud.positions.clear();
  cloud.normals.clear();
  cloud.values.clear();
  for (const Point& point : left) {
    cloud.positions.push_back(point.position);
    if (has_normals) cloud.normals.push_back(point.normal);
    if (has_values) cloud.values.push_back(point.value);
  }
  cloud.positions.shrink_to_fit();
  cloud.normals.shrink_to_fit();
  cloud.values.shrink_to_fit();
  return true;
}

}  // namespace meshgrain
