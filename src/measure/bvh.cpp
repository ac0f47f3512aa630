#include "measure/bvh.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "util/triangle.h"

namespace meshgrain {
namespace {

/// Divides items in two by their middles, along the axis on which these are farthest apart.
std::array<std::span<Index>, 2> halves(std::span<Index> items, const std::vector<Vec3>& middles) {
  const std::size_t half = items.size() / 2;
  if (items.size() > 1) {
    Eigen::AlignedBox3f box;
    for (const Index i : items) box.extend(middles[i]);
    int axis;
    box.sizes().maxCoeff(&axis);
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [&](Index a, Index b) { return middles[a][axis] < middles[b][axis]; });
  }
  return {items.first(half), items.subspan(half)};
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
  if (middles.empty()) return;
  std::vector<Index> items(middles.size());
  std::iota(items.begin(), items.end(), Index{0});
  nodes_.reserve(items.size() / 2 + 1);
  build(items, middles);
}

Index Bvh::build(std::span<Index> items, const std::vector<Vec3>& middles) {
  const auto self = static_cast<Index>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  int lane = 0;
  for (const std::span<Index> half : halves(items, middles)) {
    for (const std::span<Index> quarter : halves(half, middles)) {
      Eigen::AlignedBox3f box;  // empty
      node.child[lane] = no_index;
      node.is_item[lane] = quarter.size() == 1;
      if (node.is_item[lane]) {
        node.child[lane] = quarter[0];
        box = box_of(quarter[0]);
      } else if (!quarter.empty()) {
        node.child[lane] = build(quarter, middles);
        box = box_of(nodes_[node.child[lane]]);
      }
      constexpr float infinity = std::numeric_limits<float>::infinity();
      for (int axis = 0; axis < 3; ++axis) {
        node.low[axis][lane] = quarter.empty() ? infinity : box.min()[axis];
        node.high[axis][lane] = quarter.empty() ? -infinity : box.max()[axis];
      }
      ++lane;
    }
  }
  nodes_[self] = node;
  return self;
}

Eigen::AlignedBox3f Bvh::box_of(Index item) const {
  if (triangles_.empty()) return Eigen::AlignedBox3f(positions_[item]);
  Eigen::AlignedBox3f box;
  for (const Index v : triangles_[item]) box.extend(positions_[v]);
  return box;
}

Eigen::AlignedBox3f Bvh::box_of(const Node& node) const {
  Eigen::AlignedBox3f box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min()[axis] = node.low[axis].minCoeff();
    box.max()[axis] = node.high[axis].maxCoeff();
  }
  return box;
}

Eigen::Vector3d Bvh::closest_of(Index item, const Eigen::Vector3d& p) const {
  const auto corner = [&](Index v) { return Eigen::Vector3d(positions_[v].cast<double>()); };
  if (triangles_.empty()) return corner(item);
  const auto& [a, b, c] = triangles_[item];
  return closest_point_on_triangle(p, corner(a), corner(b), corner(c));
}

Bvh::Hit Bvh::closest(const Eigen::Vector3d& p, double squared_limit) const {
  Hit best{squared_limit, no_index, p};
  if (nodes_.empty()) return best;
  // Boxes are looked at in single precision, a little larger than they are.
  const Vec3 at = p.cast<float>();
  const float rounding = 2e-7f * at.cwiseAbs().maxCoeff();
  constexpr float less = 1 - 1e-6f;
  struct Pending {
    Index node_or_item;
    bool is_item;
    float squared_distance;  // at least
  };
  std::array<Pending, 64> stack;  // deeper than the tree: it quarters at most 2^32 items
  std::size_t top = 0;
  stack[top++] = {0, false, 0};
  while (top > 0) {
    const Pending pending = stack[--top];
    if (double{pending.squared_distance} > best.squared_distance) continue;
    if (pending.is_item) {
      const Eigen::Vector3d q = closest_of(pending.node_or_item, p);
      const double distance = (q - p).squaredNorm();
      // Of those that are as near, at a vertex or an edge, the first: it does not depend on the
      // tree.
      const bool is_first = distance == best.squared_distance && best.triangle != no_index &&
                            pending.node_or_item < best.triangle;
      if (distance < best.squared_distance || is_first) best = {distance, pending.node_or_item, q};
      continue;
    }
    const Node& node = nodes_[pending.node_or_item];
    Lanes distances = Lanes::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const Lanes outside = (node.low[axis] - at[axis]).max(at[axis] - node.high[axis]);
      distances += (outside - rounding).max(0.0f).square();
    }
    distances *= less;
    // The nearest comes last, to be the next.
    const std::size_t first = top;
    for (int k = 0; k < distances.size(); ++k) {
      if (!(double{distances[k]} <= best.squared_distance) || node.child[k] == no_index) continue;
      const Pending child{node.child[k], node.is_item[k], distances[k]};
      std::size_t place = top++;
      for (; place > first && stack[place - 1].squared_distance < child.squared_distance; --place) {
        stack[place] = stack[place - 1];
      }
      stack[place] = child;
    }
  }
  return best;
}

}  // namespace meshgrain
