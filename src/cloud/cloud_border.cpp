#include "cloud/cloud_border.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "util/collect.h"
#include "util/sort_unique.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

/// What is up to two edges away, without the node.
void two_rings(const Graph& graph, Index node, std::vector<Index>& rings) {
  const auto first = graph.neighbors_of(node);
  rings.assign(first.begin(), first.end());
  for (const Index j : first) {
    const auto second = graph.neighbors_of(j);
    rings.insert(rings.end(), second.begin(), second.end());
  }
  sort_unique(rings);
  std::erase(rings, node);
}

/// A direction in the plane of a node; `turn`, from 0 to 4, grows with its angle.
struct Direction {
  float x, y, length, turn;
};

float turn_after(float turn, float start) {
  return turn < start ? turn + 4 - start : turn - start;
}

/// Whether there are 130 degrees from one to the next. Among the directions to ten scattered points
/// that is common; among those to the forty of two rings it is not.
bool far_apart(const Direction& a, const Direction& b) {
  constexpr float cosine = -0.643f, half = 2;
  const float turn = turn_after(b.turn, a.turn);
  return turn > half || (turn > half / 2 && a.x * b.x + a.y * b.y < cosine * a.length * b.length);
}

/// Looks for directions in which a node has no others.
class Around {
 public:
  explicit Around(const Graph& graph) : graph_(graph) {}

  /// Whether nodes one or two edges away leave so much free.
  bool leaves_a_third(Index node) {
    look_from(node);
    directions_.clear();
    std::uint32_t sectors = 0;
    for (const Index j : graph_.neighbors_of(node)) {
      directions_.push_back(to(j, 0));
      sectors |= 1u << static_cast<std::uint32_t>(directions_.back().turn * sectors_of_a_turn);
    }
    if (directions_.empty() || !has_free_sectors(sectors)) return false;
    std::ranges::sort(directions_, {}, &Direction::turn);
    directions_.push_back(directions_.front());
    if (directions_.size() == 2) return true;
    const auto free = std::ranges::adjacent_find(directions_, far_apart);
    if (free == directions_.end()) return false;

    // Those two edges away matter in between alone; turns are counted from there.
    const float start = free->turn, end = turn_after(free[1].turn, start);
    directions_ = {free[0], free[1]};
    directions_[0].turn = 0;
    directions_[1].turn = end;
    for (const Index j : graph_.neighbors_of(node)) {
      for (const Index far : graph_.neighbors_of(j)) {
        const Direction direction = to(far, start);
        if (far != node && direction.turn < end) directions_.push_back(direction);
      }
    }
    std::ranges::sort(directions_, {}, &Direction::turn);
    return std::ranges::adjacent_find(directions_, far_apart) != directions_.end();
  }

 private:
  static constexpr float sectors_of_a_turn = 4;  // sixteen in all

  /// Whether there are four in a row, as there are in each 130 degrees.
  static bool has_free_sectors(std::uint32_t sectors) {
    const std::uint32_t free = ~(sectors | sectors << 16), pairs = free & free >> 1;
    return (pairs & pairs >> 2 & 0xffff) != 0;
  }

  void look_from(Index node) {
    position_ = graph_.positions[node];
    x_ = graph_.normals[node].unitOrthogonal();
    y_ = graph_.normals[node].cross(x_);
  }

  Direction to(Index node, float start) const {
    const Vec3 way = graph_.positions[node] - position_;
    const float x = way.dot(x_), y = way.dot(y_);
    const float along = x / std::max(std::abs(x) + std::abs(y), 1e-30f);
    const float turn = y >= 0 ? 1 - along : 3 + along;
    return {x, y, std::sqrt(x * x + y * y), turn_after(turn, start)};
  }

  const Graph& graph_;
  Vec3 position_, x_, y_;
  std::vector<Direction> directions_;
};

std::vector<Index> find_free(const Graph& graph, const Context& context) {
  const auto find = [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
    context.check();
    Around around(graph);
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      if (around.leaves_a_third(i)) out.push_back(i);
    }
  };
  const auto found = collect<Index>(graph.size(), find, context);
  return {found.begin(), found.end()};
}

/// The places among `some`, which increase, of those of them that are up to two edges away from
/// one.
void places_near(const Graph& graph, std::span<const Index> some, Index node,
                 std::vector<Index>& places) {
  two_rings(graph, node, places);
  std::size_t count = 0;
  for (const Index j : places) {
    const auto found = std::ranges::lower_bound(some, j);
    if (found != some.end() && *found == j) {
      places[count++] = static_cast<Index>(found - some.begin());
    }
  }
  places.resize(count);
}

/// Few of them together are a sparse place, or noise.
void drop_small_pieces(const Graph& graph, float smallest, std::vector<Index>& some) {
  constexpr std::size_t fewest = 6;
  UnionFind pieces(some.size());
  std::vector<Index> near;
  for (Index k = 0; k < some.size(); ++k) {
    places_near(graph, some, some[k], near);
    for (const Index other : near) pieces.unite(k, other);
  }
  struct Piece {
    std::size_t count = 0;
    Eigen::AlignedBox3f box;
  };
  std::vector<Piece> found(some.size());
  for (Index k = 0; k < some.size(); ++k) {
    Piece& piece = found[pieces.find(k)];
    ++piece.count;
    piece.box.extend(graph.positions[some[k]]);
  }
  std::vector<Index> kept;
  for (Index k = 0; k < some.size(); ++k) {
    const auto& [count, box] = found[pieces.find(k)];
    if (count >= fewest && box.diagonal().norm() >= smallest) kept.push_back(some[k]);
  }
  some = std::move(kept);
}

/// The line of least squares through a node of the border and others near it.
BorderNode border_node(const Graph& graph, Index node, std::span<const Index> others) {
  constexpr double straight = 0.15;  // the variance across it, of that along it
  constexpr std::size_t few = 3;     // may lie across it
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d origin = graph.positions[node].cast<double>();
  for (const Index j : others) {
    const Eigen::Vector3d d = graph.positions[j].cast<double>() - origin;
    sum += d;
    squares += d * d.transpose();
  }
  const double count = static_cast<double>(others.size() + 1);  // the node lies at zero
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      Eigen::Matrix3d(squares - sum * sum.transpose() / count));
  BorderNode found{node, (origin + sum / count).cast<float>(), Vec3::Zero()};
  if (others.size() > few && solver.eigenvalues()[1] < straight * solver.eigenvalues()[2]) {
    found.direction = solver.eigenvectors().col(2).cast<float>();
  }
  return found;
}

}  // namespace

std::vector<BorderNode> cloud_border(const Graph& graph, float smallest, const Context& context) {
  std::vector<Index> border = find_free(graph, context);
  drop_small_pieces(graph, smallest, border);
  std::vector<BorderNode> nodes(border.size());
  context.for_ranges(border.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<Index> others;
    for (std::size_t k = begin; k < end; ++k) {
      places_near(graph, border, border[k], others);
      for (Index& other : others) other = border[other];
      nodes[k] = border_node(graph, border[k], others);
    }
  });
  return nodes;
}

std::vector<std::array<Index, 2>> border_edges(const Graph& graph,
                                               std::span<const BorderNode> border) {
  std::vector<std::array<Index, 2>> edges;
  for (const BorderNode& at : border) {
    for (const Index j : graph.neighbors_of(at.node)) {
      const bool is_border = std::ranges::binary_search(border, j, {}, &BorderNode::node);
      if (at.node < j && is_border) edges.push_back({at.node, j});
    }
  }
  return edges;
}

FeatureConstraints border_constraints(std::span<const BorderNode> border) {
  FeatureConstraints result;
  for (const auto& [node, point, direction] : border) {
    if (direction.isZero(0)) continue;
    result.orientation.push_back({node, direction, 1});
    result.position.push_back({node, point, direction, 1});
  }
  return result;
}

}  // namespace meshgrain
