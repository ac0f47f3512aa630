#include "extract/cancel_singularities.h"

#include <tbb/cache_aligned_allocator.h>

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>

namespace meshgrain {
namespace {

/// Whoever carries a unit vector u out of a triangle through one of its edges changes the edge's
/// jump by -u: the sum of the triangle loses u, and that of the next gains it, turned by the
/// rotation of the edge. So triangles on the way keep their sums, and a Burgers vector moves from
/// one end of the path to the other. Dijkstra's algorithm finds the paths.
class Cancelling {
 public:
  Cancelling(LatticeMesh& lattice, double cost)
      : lattice_(lattice), map_(lattice.map), limit_(cost), posy_(lattice.posy) {
    const std::size_t states = map_.halfedges() * static_cast<std::size_t>(posy_);
    visits_.resize(states);
    costs_.resize(2 * states, unknown);
    passable_.resize(map_.halfedges(), 0);
    for (Index h = 0; h < map_.halfedges(); ++h) {
      if (lattice_.stands_for_triangle(h)) look_again(h);
    }
    weigh_lines();
  }

  void run() {
    std::priority_queue<Start> queue;
    for (Index h = 0; h < map_.halfedges(); ++h) {
      if (lattice_.stands_for_triangle(h) && is_singular(lattice_.triangle(h))) queue.push({0, h});
    }
    // The cost that a triangle is queued with is a lower bound until its path has been looked for
    // again.
    while (!queue.empty()) {
      const Start start = queue.top();
      queue.pop();
      if (!is_singular(lattice_.triangle(start.h))) continue;
      const Path path = cheapest_path(start.h);
      if (path.steps.empty()) continue;
      if (path.cost > start.cost + 1e-9) {
        queue.push({path.cost, start.h});
        continue;
      }
      for (const Step& step : path.steps) {
        lattice_.set_jump(step.h, left(step.h, step.unit));
        look_again(step.h);
        look_again(PolygonMap::twin(step.h));
      }
      queue.push({0, start.h});  // if anything is left
    }
  }

 private:
  struct Start {
    double cost;
    Index h;
    bool operator<(const Start& o) const { return std::tie(cost, h) > std::tie(o.cost, o.h); }
  };
  struct Step {
    Index h;   // the edge crossed, on the side that is left
    int unit;  // what is carried, in steps of rotation from the first axis of h's origin
  };
  struct Path {
    std::vector<Step> steps;
    double cost = 0;  // for each irregular vertex that goes
  };
  /// A halfedge through which a triangle is entered, with what is carried in the frame of its
  /// origin.
  struct State {
    Index h;
    int unit;
  };
  struct Visit {
    double cost = 0;
    std::uint32_t parent = 0;  // the number of a state
    std::uint32_t when = 0;    // twice the search in which this was so; one more once it is settled
  };
  struct Entry {
    double cost;
    std::uint32_t state;
    bool operator<(const Entry& o) const {
      return std::tie(cost, state) > std::tie(o.cost, o.state);
    }
  };

  static constexpr std::uint32_t none = ~std::uint32_t{0};
  static constexpr double unknown = -1, forbidden = std::numeric_limits<double>::infinity();
  static constexpr double least_step = 0.05;  // so that paths are no longer than they must be

  /// What changes the length of a feature line must fit in between its ends: it costs more on a
  /// short one.
  void weigh_lines() {
    std::vector<int> edges;  // of each line
    for (Index h = 0; h < map_.halfedges(); h += 2) {
      if (map_.removed(h) || !lattice_.on_feature(h)) continue;
      const Index line = lattice_.lines[h / 2];
      if (line >= edges.size()) edges.resize(line + 1, 0);
      ++edges[line];
    }
    for (const int count : edges) line_weight_.push_back(std::max(1.0, 40.0 / std::max(count, 1)));
  }

  static bool is_singular(const LatticeTriangle& triangle) {
    return !triangle.is_cone() && !triangle.is_plane();
  }

  std::uint32_t number(const State& s) const {
    return s.h * static_cast<std::uint32_t>(posy_) + static_cast<std::uint32_t>(s.unit % posy_);
  }
  State state(std::uint32_t number) const {
    return {static_cast<Index>(number / posy_), static_cast<int>(number % posy_)};
  }

  std::array<int, 2> unit(int steps) const { return rotate_jump({1, 0}, steps % posy_, posy_); }

  /// The jump of h after a unit vector has gone out through it, or come in.
  Jump left(Index h, int steps) const {
    Jump jump = lattice_.jump(h);
    const auto u = unit(steps);
    jump.t = {jump.t[0] - u[0], jump.t[1] - u[1]};
    return jump;
  }
  Jump entered(Index h, int steps) const { return left(h, steps + posy_ / 2); }

  /// What is carried, as seen from the other end of h.
  int beyond(Index h, int steps) const { return (steps + lattice_.jump(h).rotation) % posy_; }

  /// A flat triangle loses a vertex to its neighbours, one of more than half a cell gains one: both
  /// are as far from what should be.
  static double badness(const LatticeTriangle& triangle) {
    const double flaw = triangle.flaw();
    return flaw == 0 && !triangle.is_cone() ? std::max(0.0, triangle.area() - 1) : flaw;
  }

  /// The cost of carrying something through the edge of h, and of what `worse` a triangle gets.
  double step_cost(Index h, int steps, double worse) const {
    const double farther =
        lattice_.misfit(h, left(h, steps).t) - lattice_.misfit(h, lattice_.jump(h).t);
    const double weight = lattice_.on_feature(h) ? line_weight_[lattice_.lines[h / 2]] : 1;
    return weight * std::max(farther, least_step) + std::max(worse, 0.0);
  }

  /// How much worse the triangle left of g gets when something enters by g and leaves by h.
  double passing(const State& in, Index h, int out) const {
    LatticeTriangle triangle = lattice_.triangle(in.h);
    const double before = badness(triangle);
    triangle.around[0] = entered(in.h, in.unit);
    triangle.around[h == map_.next(in.h) ? 1 : 2] = left(h, out);
    return badness(triangle) - before;
  }
  double leaving(Index h, int out) const {
    LatticeTriangle triangle = lattice_.triangle(h);
    const double before = badness(triangle);
    triangle.around[0] = left(h, out);
    return badness(triangle) - before;
  }
  double ending(const State& in) const {
    LatticeTriangle triangle = lattice_.triangle(in.h);
    const double before = badness(triangle);
    triangle.around[0] = entered(in.h, in.unit);
    return std::max(0.0, badness(triangle) - before);
  }

  void visit(double cost, const State& to, std::uint32_t parent) {
    const std::uint32_t id = number(to);
    Visit& visit = visits_[id];
    if (visit.when >= 2 * search_ && visit.cost <= cost) return;
    visit = {cost, parent, 2 * search_};
    queue_.push({cost, id});
  }

  /// From the triangle left of `start`, for a unit that its Burgers vector gets shorter by.
  Path cheapest_path(Index start) {
    ++search_;
    queue_ = {};
    const Jump sum = lattice_.sum(start);
    const LatticeMetric metric = lattice_.metric();
    const double size = metric.squared_length(sum.t);
    for (int k = 0; k < posy_; ++k) {
      const auto u = unit(k);
      if (metric.squared_length(std::array<int, 2>{sum.t[0] - u[0], sum.t[1] - u[1]}) >= size)
        continue;
      int carried = k;
      Index h = start;
      for (int side = 0; side < 3; ++side) {
        const double cost = step_cost(h, carried, leaving(h, carried));
        const bool may = may_carry(h, carried);
        carried = beyond(h, carried);
        if (may) visit(cost, {PolygonMap::twin(h), carried}, none);
        h = map_.next(h);
      }
    }
    // A singularity costs two irregular vertices. At the end of the path another may vanish as
    // well, so that a longer path can be the cheaper one for each of them.
    const double here = size == 1 ? 2 : 1;
    Path best;
    best.cost = limit_;
    std::uint32_t last = none;
    while (!queue_.empty()) {
      const Entry entry = queue_.top();
      queue_.pop();
      Visit& found = visits_[entry.state];
      if (found.when > 2 * search_ || entry.cost > found.cost) continue;
      found.when = 2 * search_ + 1;
      if (entry.cost >= best.cost * (here + 2)) break;
      const State in = state(entry.state);
      const std::optional<double> there = gain(in, start);
      if (!there) {
        pass_on(in, entry);
        continue;
      }
      if (*there < 0) continue;
      const double end = lattice_.holes[in.h] ? 0 : ending(in);
      const double cost = (entry.cost + end) / (here + *there);
      if (cost >= best.cost) continue;
      best.cost = cost;
      last = entry.state;
    }
    for (std::uint32_t s = last; s != none; s = visits_[s].parent) {
      const State in = state(s);
      const Index h = PolygonMap::twin(in.h);
      best.steps.push_back({h, (in.unit + posy_ - lattice_.jump(h).rotation) % posy_});
    }
    return best;
  }

  /// How many irregular vertices vanish if a path ends here; nothing if it only passes, less than 0
  /// if it can do neither.
  std::optional<double> gain(const State& in, Index start) const {
    if (passable_[in.h]) return std::nullopt;
    if (lattice_.holes[in.h]) return 0;
    if (in.h == start || map_.next(in.h) == start || map_.prev(in.h) == start) return -1;
    const Jump sum = lattice_.sum(in.h);
    if (sum.rotation != 0) return 0;
    const auto u = unit(in.unit);
    const LatticeMetric metric = lattice_.metric();
    const double after =
        metric.squared_length(std::array<int, 2>{sum.t[0] + u[0], sum.t[1] + u[1]});
    if (after >= metric.squared_length(sum.t)) return std::nullopt;
    return after == 0 ? 2 : 1;
  }

  /// Lines of features stay on their axis, and keep their vertices apart.
  bool may_carry(Index h, int carried) const {
    if (!lattice_.on_feature(h)) return true;
    const Jump after = left(h, carried);
    return !after.is_zero() && !lattice_.leaves_axis(h, after.t);
  }

  void pass_on(const State& in, const Entry& entry) {
    int carried = beyond(in.h, in.unit);
    Index h = map_.next(in.h);
    for (int side = 0; side < 2; ++side) {
      // Of all that a search asks for this is the most work, and the next searches ask again.
      double& cost = costs_[2 * std::size_t{entry.state} + static_cast<std::size_t>(side)];
      if (cost == unknown) cost = passing_cost(in, h, carried);
      carried = beyond(h, carried);
      if (cost != forbidden) visit(entry.cost + cost, {PolygonMap::twin(h), carried}, entry.state);
      h = map_.next(h);
    }
  }
  double passing_cost(const State& in, Index h, int carried) const {
    if (!may_carry(h, carried)) return forbidden;
    return step_cost(h, carried, passing(in, h, carried));
  }
  /// At the triangle left of h, which has changed.
  void look_again(Index h) {
    if (lattice_.holes[h]) return;
    const bool is_plane = lattice_.triangle(h).is_plane();
    for (int corner = 0; corner < 3; ++corner, h = map_.next(h)) {
      const std::size_t first = 2 * std::size_t{number({h, 0})};
      std::fill_n(costs_.begin() + static_cast<std::ptrdiff_t>(first), 2 * posy_, unknown);
      passable_[h] = is_plane;
    }
  }

  LatticeMesh& lattice_;
  const PolygonMap& map_;
  double limit_;
  int posy_;
  // What a search waits for is memory: aligned, so that all states of a halfedge are in one line.
  template <typename T>
  using Aligned = std::vector<T, tbb::cache_aligned_allocator<T>>;
  Aligned<Visit> visits_;  // of each state
  Aligned<double> costs_;  // of each state, for passing on to the left and to the right
  std::vector<std::uint8_t> passable_;  // of each halfedge: a plane on its left ends no path
  std::vector<double> line_weight_;
  std::priority_queue<Entry> queue_;
  std::uint32_t search_ = 0;
};

}  // namespace

void cancel_position_singularities(LatticeMesh& lattice, double cost) {
  if (cost > 0) Cancelling(lattice, cost).run();
}

}  // namespace meshgrain
