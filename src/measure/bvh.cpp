#include "measure/bvh.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "util/triangle.h"

namespace meshgrain {
namespace {

constexpr Index leaf_size = 2;

double squared_distance_to_box(const Eigen::Vector3d& p, const Vec3& low, const Vec3& high) {
  const Eigen::Vector3d below = low.cast<double>() - p, above = p - high.cast<double>();
  return below.cwiseMax(above).cwiseMax(0.0).squaredNorm();
}

}  // namespace

Bvh::Bvh(const Mesh& mesh) : Bvh(mesh.positions, triangles_of(mesh)) {
  if (mesh.is_point_cloud()) build(positions_);
}

Bvh::Bvh(const std::vector<Vec3>& positions, std::vector<Triangle> triangles)
    : positions_(positions), triangles_(std::move(triangles)) {
  std::vector<Vec3> middles;
  middles.reserve(triangles_.size());
  for (const auto& [a, b, c] : triangles_) {
    middles.push_back((positions_[a] + positions_[b] + positions_[c]) / 3);
  }
  build(middles);
}

void Bvh::build(const std::vector<Vec3>& middles) {
  const std::size_t count = middles.size();
  items_.resize(count);
  std::iota(items_.begin(), items_.end(), Index{0});
  nodes_.reserve(2 * count);
  if (count > 0) build(0, static_cast<Index>(count), middles);
}

Index Bvh::build(Index begin, Index end, const std::vector<Vec3>& middles) {
  const Index self = static_cast<Index>(nodes_.size());
  nodes_.push_back({Vec3::Constant(std::numeric_limits<float>::infinity()),
                    Vec3::Constant(-std::numeric_limits<float>::infinity()), begin, end - begin});
  if (end - begin <= leaf_size) {
    Node& leaf = nodes_[self];
    const auto cover = [&](Index v) {
      leaf.low = leaf.low.cwiseMin(positions_[v]);
      leaf.high = leaf.high.cwiseMax(positions_[v]);
    };
    for (Index i = begin; i < end; ++i) {
      if (triangles_.empty())
        cover(items_[i]);
      else
        for (Index v : triangles_[items_[i]]) cover(v);
    }
    return self;
  }
  Vec3 low = middles[items_[begin]], high = low;
  for (Index i = begin; i < end; ++i) {
    low = low.cwiseMin(middles[items_[i]]);
    high = high.cwiseMax(middles[items_[i]]);
  }
  int axis;
  (high - low).maxCoeff(&axis);
  const Index half = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + half, items_.begin() + end,
                   [&](Index a, Index b) { return middles[a][axis] < middles[b][axis]; });
  const Index left = build(begin, half, middles);
  const Index right = build(half, end, middles);
  nodes_[self] = {nodes_[left].low.cwiseMin(nodes_[right].low),
                  nodes_[left].high.cwiseMax(nodes_[right].high), right, 0};
  return self;
}

Bvh::Hit Bvh::closest(const Eigen::Vector3d& p, double squared_limit) const {
  Hit best{squared_limit, no_index, p};
  if (nodes_.empty()) return best;
  const auto distance_to = [&](Index node) {
    return squared_distance_to_box(p, nodes_[node].low, nodes_[node].high);
  };
  struct Pending {
    Index node;
    double squared_distance;
  };
  std::array<Pending, 64> stack;  // deeper than the tree: it halves at most 2^32 items
  std::size_t top = 0;
  stack[top++] = {0, distance_to(0)};
  while (top > 0) {
    const Pending pending = stack[--top];
    if (pending.squared_distance >= best.squared_distance) continue;
    const Node& node = nodes_[pending.node];
    if (node.count == 0) {
      Pending near{pending.node + 1, distance_to(pending.node + 1)};
      Pending far{node.first, distance_to(node.first)};
      if (far.squared_distance < near.squared_distance) std::swap(near, far);
      stack[top++] = far;
      stack[top++] = near;
      continue;
    }
    for (Index i = node.first; i < node.first + node.count; ++i) {
      const Index item = items_[i];
      const auto corner = [&](Index v) { return Eigen::Vector3d(positions_[v].cast<double>()); };
      const Eigen::Vector3d q =
          triangles_.empty()
              ? corner(item)
              : closest_point_on_triangle(p, corner(triangles_[item][0]),
                                          corner(triangles_[item][1]), corner(triangles_[item][2]));
      const double distance = (q - p).squaredNorm();
      if (distance < best.squared_distance) best = {distance, item, q};
    }
  }
  return best;
}

}  // namespace meshgrain
