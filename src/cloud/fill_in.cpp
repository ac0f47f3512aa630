#include "cloud/fill_in.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "cloud/spacing.h"
#include "util/collect.h"
#include "util/hash.h"

namespace meshgrain {
namespace {

// How far a new point is from all others, of the distance between those it is put between and of
// what may be apart.
constexpr float clear = 0.4f, clear_of_apart = 0.6f;

/// Half way between two points.
struct Middle {
  float length;  // from one point to the other
  Index from, to;

  bool operator<(const Middle& other) const {
    return std::tie(length, from, to) < std::tie(other.length, other.from, other.to);
  }
};

/// Points that are found by where they are.
class Cells {
 public:
  explicit Cells(float side) : side_(side) {}

  void add(const Vec3& p) { cells_[key(cell(p))].push_back(p); }

  bool has_within(float radius, const Vec3& p) const {
    const Cell low = cell(p - Vec3::Constant(radius)), high = cell(p + Vec3::Constant(radius));
    for (std::int64_t x = low.x(); x <= high.x(); ++x)
      for (std::int64_t y = low.y(); y <= high.y(); ++y)
        for (std::int64_t z = low.z(); z <= high.z(); ++z) {
          const auto found = cells_.find(key({x, y, z}));
          if (found == cells_.end()) continue;
          for (const Vec3& q : found->second) {
            if ((q - p).squaredNorm() < radius * radius) return true;
          }
        }
    return false;
  }

 private:
  using Cell = Eigen::Matrix<std::int64_t, 3, 1>;

  Cell cell(const Vec3& p) const { return (p / side_).array().floor().cast<std::int64_t>(); }
  static std::uint64_t key(const Cell& c) {
    return hash64(
        hash64(hash64(static_cast<std::uint64_t>(c.x())) ^ static_cast<std::uint64_t>(c.y())) ^
        static_cast<std::uint64_t>(c.z()));
  }

  float side_;
  std::unordered_map<std::uint64_t, std::vector<Vec3>> cells_;
};

/// Whether a surface may go from one point to the other: not through a thin part, or across a gap
/// between two of them.
bool may_be_joined(const Mesh& cloud, Index i, Index j, float length) {
  constexpr float alike = -0.2f, steep = 0.75f;  // sharp edges are crossed
  const Vec3 way = (cloud.positions[j] - cloud.positions[i]) / length;
  return cloud.normals[i].dot(cloud.normals[j]) > alike &&
         std::abs(way.dot(cloud.normals[i])) < steep && std::abs(way.dot(cloud.normals[j])) < steep;
}

/// The middle of an arc that touches the planes at both ends: half way up to them.
Vec3 middle_of_arc(const Mesh& cloud, Index i, Index j) {
  const Vec3 &p = cloud.positions[i], &q = cloud.positions[j];
  const Vec3 &n = cloud.normals[i], &m = cloud.normals[j];
  const Vec3 middle = 0.5f * (p + q);
  return middle - 0.25f * (n.dot(middle - p) * n + m.dot(middle - q) * m);
}

std::vector<Middle> find_middles(const Mesh& cloud, const Neighborhoods& nearest, float apart,
                                 const Context& context) {
  constexpr float room = 2 * clear_of_apart;
  const auto find = [&](std::size_t begin, std::size_t end, std::vector<Middle>& out) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      for (const Index j : nearest[i]) {
        const bool is_mutual = std::ranges::find(nearest[j], i) != nearest[j].end();
        if (is_mutual && j < i) continue;
        const float length = (cloud.positions[j] - cloud.positions[i]).norm();
        if (length > room * apart && may_be_joined(cloud, i, j, length))
          out.push_back({length, i, j});
      }
    }
  };
  const auto found = collect<Middle>(cloud.positions.size(), find, context);
  std::vector<Middle> middles(found.begin(), found.end());
  std::sort(middles.begin(),
            middles.end());  // between nearer points it is better known where the surface is
  return middles;
}

void add_point(Mesh& cloud, const Middle& middle, const Vec3& position) {
  const auto [length, i, j] = middle;
  const Vec3 normal = cloud.normals[i] + cloud.normals[j];
  cloud.positions.push_back(position);
  cloud.normals.push_back(normal.normalized());
  if (!cloud.values.empty()) {
    cloud.values.push_back(0.5f * (cloud.values[i] + cloud.values[j]));
  }
}

/// How far apart they are, about.
float spacing_of(const Mesh& cloud, const Neighborhoods& nearest, const Context& context) {
  const float squared = median(squared_distances(cloud.positions, nearest, context));
  return std::sqrt(area_of_point(squared, nearest.k));
}

/// Of edges that cross each other, or reach past the next points, not each has room for one.
void add_where_clear(Mesh& cloud, std::span<const Middle> middles, float apart,
                     const Context& context) {
  Cells cells(apart);
  for (const Vec3& p : cloud.positions) cells.add(p);
  for (const Middle& middle : middles) {
    context.check();
    const Vec3 position = middle_of_arc(cloud, middle.from, middle.to);
    const float radius = std::max(clear * middle.length, clear_of_apart * apart);
    if (cells.has_within(radius, position)) continue;
    cells.add(position);
    add_point(cloud, middle, position);
  }
}

}  // namespace

std::size_t fill_in(Mesh& cloud, Neighborhoods& nearest, float apart, const Context& context) {
  if (find_middles(cloud, nearest, apart, context).empty()) return 0;
  // Scattered points leave gaps that are to be closed first, and that few neighbours reach across.
  constexpr float finer = 0.6f;
  constexpr std::size_t hardly_any = 100;  // one for so many that there are
  const std::size_t before = cloud.positions.size();
  float now = std::max(apart, spacing_of(cloud, nearest, context));
  for (;;) {
    const auto farther = nearest_neighbors(cloud.positions, 2 * nearest.k, context);
    const std::size_t count = cloud.positions.size();
    add_where_clear(cloud, find_middles(cloud, farther, now, context), now, context);
    const std::size_t added = cloud.positions.size() - count;
    if (added * hardly_any <= count && now == apart) break;
    now = std::max(apart, finer * now);
  }
  nearest = nearest_neighbors(cloud.positions, nearest.k, context);
  return cloud.positions.size() - before;
}

}  // namespace meshgrain
