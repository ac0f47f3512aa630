#include "measure/crossings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "measure/face_grid.h"
#include "util/collect.h"

namespace meshgrain {
namespace {

using Corners = std::array<Index, 3>;
using Points = std::array<Eigen::Vector3d, 3>;

struct Triangle {
  Corners corners;
  Points points;
  Eigen::Vector3d normal;  // twice as long as the area
};

/// The triangles of a face: of a quad, those on either side of both diagonals.
class FaceTriangles {
 public:
  FaceTriangles(const Mesh& mesh, Index f) {
    const std::span<const Index> face = mesh.faces[f];
    fan_ = face.size() - 2;
    const std::size_t count = face.size() == 4 ? 4 : fan_;
    if (count > few_.size()) many_.resize(count);
    all_ = many_.empty() ? std::span(few_).first(count) : std::span(many_);
    const auto set = [&](std::size_t which, const Corners& corners) {
      Triangle& t = all_[which];
      t.corners = corners;
      for (int k = 0; k < 3; ++k) t.points[k] = mesh.positions[corners[k]].cast<double>();
      t.normal = (t.points[1] - t.points[0]).cross(t.points[2] - t.points[0]);
    };
    for (std::size_t k = 0; k < fan_; ++k) set(k, {face[0], face[k + 1], face[k + 2]});
    if (count == fan_) return;
    set(2, {face[1], face[2], face[3]});
    set(3, {face[1], face[3], face[0]});
  }
  FaceTriangles(const FaceTriangles&) = delete;
  FaceTriangles& operator=(const FaceTriangles&) = delete;

  std::span<const Triangle> all() const { return all_; }
  /// Those that have all of its corners already.
  std::span<const Triangle> fan() const { return all().first(fan_); }

 private:
  std::array<Triangle, 4> few_;
  std::vector<Triangle> many_;  // where there are more
  std::span<Triangle> all_;
  std::size_t fan_;
};

// Faces are taken a little larger than they are, so that what only touches counts too.
constexpr double margin = 1e-3;

/// Of the corners of a triangle over the plane of another, times the length of its normal.
using Heights = std::array<double, 3>;
Heights heights(const Triangle& triangle, const Triangle& plane) {
  Heights result;
  for (int k = 0; k < 3; ++k) result[k] = plane.normal.dot(triangle.points[k] - plane.points[0]);
  return result;
}

/// Whether what has heights between these lies on one side.
bool beside(double low, double high) {
  const double more = margin * (high - low);
  return low - more > 0 || high + more < 0;
}
bool beside(const Heights& heights) {
  const auto [low, high] = std::minmax({heights[0], heights[1], heights[2]});
  return beside(low, high);
}

/// Whether a whole face lies on one side of a triangle of another.
bool beside(const FaceTriangles& face, const Triangle& plane) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Triangle& triangle : face.fan()) {
    for (const double height : heights(triangle, plane)) {
      low = std::min(low, height);
      high = std::max(high, height);
    }
  }
  return beside(low, high);
}

/// How far the nearer end of an edge of one triangle lies beyond another that it passes through,
/// else 0. `over` are the heights of the former over the latter.
double depth(const Triangle& of, int edge, const Heights& over, const Triangle& triangle) {
  const double from = over[edge], to = over[(edge + 1) % 3];
  const double closest = 2 * margin * std::abs(to - from);  // most edges are far from that
  if (std::min(from, to) > closest || std::max(from, to) < -closest) return 0;
  const Eigen::Vector3d &p = of.points[edge], &q = of.points[(edge + 1) % 3];
  const Eigen::Vector3d& normal = triangle.normal;
  const Eigen::Vector3d more = margin * (q - p);
  const Eigen::Vector3d s = p - more - triangle.points[0], t = q + more - triangle.points[0];
  const double ds = normal.dot(s), dt = normal.dot(t);
  if (!(ds * dt < 0)) return 0;
  const Eigen::Vector3d u = triangle.points[1] - triangle.points[0];
  const Eigen::Vector3d v = triangle.points[2] - triangle.points[0];
  const Eigen::Vector3d x = s + ds / (ds - dt) * (t - s);
  const double outside = -margin * normal.squaredNorm();
  if (normal.dot(u.cross(x)) < outside || normal.dot((v - u).cross(x - u)) < outside ||
      normal.dot(x.cross(v)) < outside) {
    return 0;
  }
  return std::min(std::abs(ds), std::abs(dt)) / normal.norm();
}

/// Calls add(depth) for the edges of two triangles that may pass through the other one, while it
/// returns true. Returns whether it always did.
template <typename Add>
bool add_depths(const Triangle& a, const Triangle& b, const Add& add) {
  int shared = 0, own = 0, other = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (a.corners[i] != b.corners[j]) continue;
      ++shared;
      own = i;
      other = j;
    }
  }
  if (shared > 1) return true;
  const Heights b_over_a = heights(b, a), a_over_b = heights(a, b);
  // At a shared corner only the edges opposite of it can pass through.
  if (shared == 1) {
    return add(depth(a, (own + 1) % 3, a_over_b, b)) && add(depth(b, (other + 1) % 3, b_over_a, a));
  }
  if (beside(b_over_a) || beside(a_over_b)) return true;
  for (int k = 0; k < 3; ++k) {
    if (!add(depth(a, k, a_over_b, b)) || !add(depth(b, k, b_over_a, a))) return false;
  }
  return true;
}

/// Whether a plane parts two faces, but for the corners that they share: so most neighbours lie,
/// and this is a small part of the work of comparing their triangles.
bool are_parted(const Mesh& mesh, std::span<const Index> f, std::span<const Index> g) {
  constexpr std::size_t most = 64;  // corners, for which there are bits
  if (std::max(f.size(), g.size()) > most) return false;
  std::uint64_t f_shares = 0, g_shares = 0;
  std::array<Index, 2> shared{no_index, no_index};
  std::size_t count = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    for (std::size_t j = 0; j < g.size(); ++j) {
      if (f[i] != g[j]) continue;
      if (count == shared.size()) return false;
      shared[count++] = f[i];
      f_shares |= std::uint64_t{1} << i;
      g_shares |= std::uint64_t{1} << j;
    }
  }
  const auto middle = [&](std::span<const Index> face) {
    Vec3 sum = Vec3::Zero();
    for (const Index v : face) sum += mesh.positions[v];
    return Vec3(sum / static_cast<float>(face.size()));
  };
  Vec3 across = middle(g) - middle(f);
  const Vec3& origin = mesh.positions[count > 0 ? shared[0] : f[0]];
  if (count == 2) {
    const Vec3 edge = mesh.positions[shared[1]] - origin;
    across -= edge * (edge.dot(across) / std::max(edge.squaredNorm(), 1e-30f));
  }
  const auto range = [&](std::span<const Index> face, std::uint64_t shares) {
    std::array<float, 2> result{std::numeric_limits<float>::infinity(),
                                -std::numeric_limits<float>::infinity()};
    for (std::size_t k = 0; k < face.size(); ++k) {
      if ((shares >> k & 1) != 0) continue;
      const float height = across.dot(mesh.positions[face[k]] - origin);
      result = {std::min(result[0], height), std::max(result[1], height)};
    }
    return result;
  };
  const auto [f_low, f_high] = range(f, f_shares);
  const auto [g_low, g_high] = range(g, g_shares);
  const float clear = 10 * static_cast<float>(margin) * (g_high - f_low);
  return count == 0 ? g_low - f_high > clear : f_high < -clear && g_low > clear;
}

/// The same for all triangles of two faces whose boxes meet.
template <typename Add>
void add_depths(const Mesh& mesh, Index f, Index g, const Add& add) {
  if (are_parted(mesh, mesh.faces[f], mesh.faces[g])) return;
  const FaceTriangles own(mesh, f), other(mesh, g);
  for (const Triangle& t : own.all()) {
    if (beside(other, t)) continue;
    for (const Triangle& u : other.all()) {
      if (!add_depths(t, u, add)) return;
    }
  }
}

/// Pairs of faces whose boxes meet and that are wanted, the lower number first, in increasing
/// order.
template <typename IsWanted>
std::vector<std::array<Index, 2>> find_pairs(const Mesh& mesh, const Context& context,
                                             const IsWanted& is_wanted) {
  const FaceGrid grid(mesh, context);
  const auto result_of = [&](std::size_t count, const auto& for_each_pair) {
    return collect<std::array<Index, 2>>(
        count,
        [&](std::size_t begin, std::size_t end, std::vector<std::array<Index, 2>>& found) {
          for (std::size_t k = begin; k < end; ++k) {
            for_each_pair(k, [&](Index f, Index g) {
              if (is_wanted(f, g)) found.push_back({f, g});
            });
          }
        },
        context);
  };
  auto result = result_of(grid.buckets(), [&](std::size_t bucket, const auto& body) {
    grid.for_each_pair(bucket, body);
  });
  if (grid.has_large_faces()) {
    const auto more = result_of(mesh.faces.size(), [&](std::size_t f, const auto& body) {
      grid.for_each_larger(static_cast<Index>(f), body);
    });
    result.insert(result.end(), more.begin(), more.end());
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

double penetration_of_near(const Mesh& mesh, Index f, Index g) {
  double sum = 0;
  add_depths(mesh, f, g, [&](double depth) {
    sum += depth;
    return true;
  });
  return sum;
}

bool cross_if_near(const Mesh& mesh, Index f, Index g) {
  bool any = false;
  add_depths(mesh, f, g, [&](double depth) { return !(any = depth > 0); });
  return any;
}

double penetration(const Mesh& mesh, Index f, Index g) {
  if (f == g || !face_box(mesh, f).intersects(face_box(mesh, g))) return 0;
  return penetration_of_near(mesh, f, g);
}

std::vector<std::array<Index, 2>> find_crossings(const Mesh& mesh, const Context& context) {
  return find_pairs(mesh, context, [&](Index f, Index g) { return cross_if_near(mesh, f, g); });
}

std::vector<std::array<Index, 2>> find_crossings_of(const Mesh& mesh,
                                                    std::span<const std::uint8_t> marked,
                                                    const Context& context) {
  return find_pairs(mesh, context, [&](Index f, Index g) {
    return (marked[f] | marked[g]) != 0 && cross_if_near(mesh, f, g);
  });
}

std::size_t count_crossings_of(const Mesh& mesh, std::span<const Index> some,
                               const Context& context) {
  return count_crossings_of(mesh, some, face_boxes(mesh, context), context);
}

std::size_t count_crossings_of(const Mesh& mesh, std::span<const Index> some,
                               std::span<const Eigen::AlignedBox3f> boxes, const Context& context) {
  std::vector<Eigen::AlignedBox3f> own;
  Eigen::AlignedBox3f whole;
  std::atomic<std::size_t> count = 0;
  for (std::size_t k = 0; k < some.size(); ++k) {
    own.push_back(face_box(mesh, some[k]));
    whole.extend(own[k]);
    for (std::size_t i = 0; i < k; ++i) {
      count += own[i].intersects(own[k]) && cross_if_near(mesh, some[i], some[k]);
    }
  }
  constexpr std::size_t grain = 4096;
  context.for_ranges(mesh.faces.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::size_t here = 0;
    for (auto g = static_cast<Index>(begin); g < end; ++g) {
      if (!boxes[g].intersects(whole) || std::ranges::binary_search(some, g)) continue;
      for (std::size_t k = 0; k < some.size(); ++k) {
        here += own[k].intersects(boxes[g]) && cross_if_near(mesh, some[k], g);
      }
    }
    count += here;
  });
  return count;
}

}  // namespace meshgrain
