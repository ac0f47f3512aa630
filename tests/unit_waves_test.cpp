#include "extract/unit_waves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "extract/cancel_singularities.h"
#include "extract/unit_carrier.h"
#include "made_graph.h"
#include "made_lattice.h"
#include "meshgrain/clean.h"
#include "meshgrain/shapes.h"
#include "meshgrain/surface.h"

namespace meshgrain {
namespace {

using State = UnitCarrier::State;
using Meeting = UnitWaves::Meeting;

/// With noise, so that there are singularities.
Mesh closed_shape() {
  return made::shaken(sample_shape("blob"), 0.015f);
}
/// The same with a border around a hole.
Mesh open_shape() {
  const Mesh whole = closed_shape();
  Mesh open;
  open.positions = whole.positions;
  for (std::size_t f = 0; f < whole.faces.size(); ++f) {
    const auto face = whole.faces[f];
    if (whole.positions[face[0]].z() < 0.4f) open.faces.push_back(face);
  }
  clean(open);
  return open;
}

LatticeMesh lattice_of(const Mesh& mesh, int posy,
                       const std::vector<std::uint8_t>& keeps_singularities = {}) {
  return made::lattice(mesh, posy, 3 * static_cast<float>(edge_lengths(mesh).mean),
                       keeps_singularities);
}

struct Case {
  std::string name;
  LatticeMesh lattice;
};
std::vector<Case> closed_and_open() {
  std::vector<Case> result;
  for (const int posy : {4, 6}) {
    const std::string symmetry = ", posy " + std::to_string(posy);
    result.push_back({"closed" + symmetry, lattice_of(closed_shape(), posy)});
    result.push_back({"open" + symmetry, lattice_of(open_shape(), posy)});
  }
  return result;
}
std::vector<Case> with_creases() {
  std::vector<Case> result = closed_and_open();
  for (const int posy : {4, 6}) {
    result.push_back(
        {"creases, posy " + std::to_string(posy), lattice_of(sample_shape("bracket"), posy)});
  }
  return result;
}

std::vector<Index> triangles(const LatticeMesh& lattice) {
  std::vector<Index> result;
  for (Index h = 0; h < lattice.map.halfedges(); ++h) {
    if (lattice.stands_for_triangle(h)) result.push_back(h);
  }
  return result;
}

bool is_singular(const LatticeMesh& lattice, Index h) {
  const LatticeTriangle triangle = lattice.triangle(h);
  return !triangle.is_cone() && !triangle.is_plane();
}

std::array<int, 2> unit_vector(int unit, int posy) {
  return rotate_jump({1, 0}, unit, posy);
}

std::vector<Index> singular_triangles(const LatticeMesh& lattice) {
  std::vector<Index> result = triangles(lattice);
  std::erase_if(result, [&](Index h) { return !is_singular(lattice, h); });
  return result;
}

/// Changes the jump of an edge by a vector, or its opposite.
void add(LatticeMesh& lattice, Index h, const std::array<int, 2>& u, int sign) {
  Jump jump = lattice.jump(h);
  jump.t = {jump.t[0] + sign * u[0], jump.t[1] + sign * u[1]};
  lattice.set_jump(h, jump);
}

/// How many edges each line has.
std::map<Index, int> line_lengths(const LatticeMesh& lattice) {
  std::map<Index, int> result;
  for (Index h = 0; h < lattice.map.halfedges(); h += 2) {
    if (!lattice.map.removed(h) && lattice.on_feature(h)) ++result[lattice.lines[h / 2]];
  }
  return result;
}

/// A corner of the features that a triangle is a cone around, or no_index.
Index held_apex(const LatticeMesh& lattice, Index h) {
  for (const Index g : {h, lattice.map.next(h), lattice.map.prev(h)}) {
    const Jump sum = lattice.sum(g);
    const bool is_apex = sum.rotation != 0 && sum.is_zero();
    if (is_apex && lattice.hold[lattice.map.origin(g)] == at_corner) return g;
  }
  return no_index;
}

/// The cost of passing from one edge of a triangle to another, by doing it.
double cost_of_passing(LatticeMesh& lattice, const std::map<Index, int>& lengths, Index in,
                       int unit, Index out, int turned) {
  const std::array<int, 2> entering = unit_vector(unit, lattice.posy);
  const std::array<int, 2> leaving = unit_vector(turned, lattice.posy);
  const Jump before = lattice.jump(out), sum = lattice.sum(in);
  const double misfit = lattice.triangle(in).misfit();
  const Index apex = held_apex(lattice, in);
  add(lattice, in, entering, 1);
  add(lattice, out, leaving, -1);
  const bool moves_apex = apex != no_index && !lattice.sum(apex).is_zero();
  const Jump after = lattice.jump(out);
  const double worse = lattice.triangle(in).misfit() - misfit;
  EXPECT_EQ(lattice.sum(in).t, sum.t);  // nothing stays
  EXPECT_EQ(lattice.sum(in).rotation, sum.rotation);
  add(lattice, in, entering, -1);
  add(lattice, out, leaving, 1);
  if (moves_apex) return std::numeric_limits<double>::infinity();
  double crossing = std::max(lattice.misfit(out, after.t) - lattice.misfit(out, before.t), 0.05);
  if (lattice.on_feature(out)) {
    if (after.is_zero() || lattice.spoils_line(out, after.t)) {
      return std::numeric_limits<double>::infinity();
    }
    crossing *= std::max(1.0, 40.0 / lengths.at(lattice.lines[out / 2]));
  }
  return crossing + std::max(worse, 0.0);
}

/// For a plane, where waves pass, this is the short way to the cost; for all else it is the long
/// one.
TEST(UnitCarrier, PassingCostsWhatItDoesToTheTriangle) {
  for (Case& c : with_creases()) {
    SCOPED_TRACE(c.name);
    LatticeMesh& lattice = c.lattice;
    const UnitCarrier carrier(lattice, Context());
    const std::map<Index, int> lengths = line_lengths(lattice);
    std::size_t planes = 0, others = 0, forbidden = 0;
    for (const Index first : triangles(lattice)) {
      const bool on_line = lattice.on_feature(first) ||
                           lattice.on_feature(lattice.map.next(first)) ||
                           lattice.on_feature(lattice.map.prev(first));
      ++(lattice.triangle(first).is_plane() && !on_line ? planes : others);
      for (const Index in : {first, lattice.map.next(first), lattice.map.prev(first)}) {
        const Index next = lattice.map.next(in), last = lattice.map.next(next);
        for (int unit = 0; unit < lattice.posy; ++unit) {
          const auto costs = carrier.passing(carrier.state(in, unit));
          // As the next corner sees it, and the last one.
          const int to_next = (unit + lattice.jump(in).rotation) % lattice.posy;
          const int to_last = (to_next + lattice.jump(next).rotation) % lattice.posy;
          const double expected[] = {cost_of_passing(lattice, lengths, in, unit, next, to_next),
                                     cost_of_passing(lattice, lengths, in, unit, last, to_last)};
          for (std::size_t k = 0; k < 2; ++k) {
            if (std::isinf(expected[k])) {
              EXPECT_EQ(costs[k], UnitCarrier::forbidden);
              ++forbidden;
            } else {
              EXPECT_NEAR(costs[k], expected[k], 1e-3 * std::max(1.0, expected[k]));
            }
          }
        }
      }
    }
    EXPECT_GT(planes, 300u);
    EXPECT_GT(others, 5u);
    EXPECT_EQ(forbidden > 0, !lengths.empty());
  }
}

/// Whoever looks from the other side sees the opposite unit, at the same cost.
TEST(UnitCarrier, CrossingCostsTheSameFromBothSides) {
  for (const Case& c : with_creases()) {
    SCOPED_TRACE(c.name);
    const UnitCarrier carrier(c.lattice, Context());
    for (const Index first : triangles(c.lattice)) {
      for (int unit = 0; unit < c.lattice.posy; ++unit) {
        State out = carrier.state(first, unit);
        for (int side = 0; side < 3; ++side, out = carrier.along(out)) {
          const State there = carrier.across(out);
          EXPECT_EQ(carrier.halfedge(there), PolygonMap::twin(carrier.halfedge(out)));
          EXPECT_EQ(carrier.number(carrier.across(there)), carrier.number(out));
          if (c.lattice.holes[carrier.halfedge(there)]) continue;
          const float here = carrier.crossing(out);
          const float back = carrier.crossing(carrier.opposite(there));
          if (here == UnitCarrier::forbidden) {
            EXPECT_EQ(back, here);
          } else {
            EXPECT_NEAR(here, back, 1e-3 * std::max(1.0f, here));
          }
        }
      }
    }
  }
}

/// Dijkstra's algorithm, plain and slow.
struct SlowWaves {
  struct Label {
    float cost = std::numeric_limits<float>::infinity();
    Index start = no_index;
  };
  std::vector<Label> labels;  // of each state

  SlowWaves(const UnitCarrier& carrier, const std::vector<Index>& starts, float radius)
      : labels(carrier.states()) {
    using Entry = std::tuple<float, std::uint32_t, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index h : starts) {
      for (int unit = 0; unit < carrier.units(); ++unit) {
        State out = carrier.state(h, unit);
        for (int side = 0; side < 3; ++side, out = carrier.along(out)) {
          if (!carrier.shortens(out)) continue;
          queue.push({carrier.leaving(out), carrier.number(carrier.across(out)), h});
        }
      }
    }
    while (!queue.empty()) {
      const auto [cost, number, start] = queue.top();
      queue.pop();
      if (!(cost < radius) || labels[number].start != no_index) continue;
      labels[number] = {cost, start};
      const State in = carrier.state(number);
      const bool is_back =
          UnitCarrier::triangle(in) == UnitCarrier::triangle(carrier.state(start, 0));
      if (is_back || carrier.gain(in)) continue;
      const auto costs = carrier.passing(in);
      const State next = carrier.along(in), last = carrier.along(next);
      queue.push({cost + costs[0], carrier.number(carrier.across(next)), start});
      queue.push({cost + costs[1], carrier.number(carrier.across(last)), start});
    }
  }
};

/// A wave with another one, or (no_index) alone, by where they start.
using Pair = std::pair<Index, Index>;
using Costs = std::map<Pair, float>;

void note(Costs& costs, Index from, Index to, float cost) {
  const auto [it, is_new] = costs.try_emplace(std::minmax(from, to), cost);
  if (!is_new) it->second = std::min(it->second, cost);
}

/// What the cheapest meetings of each two waves cost.
Costs meetings_of(const SlowWaves& waves, const UnitCarrier& carrier) {
  Costs result;
  for (std::uint32_t here = 0; here < waves.labels.size(); ++here) {
    const auto& label = waves.labels[here];
    if (label.start == no_index) continue;
    const State in = carrier.state(here);
    if (carrier.gain(in) == 0 && carrier.ending(in) != UnitCarrier::forbidden) {
      note(result, label.start, no_index, label.cost + carrier.ending(in));
    }
    const auto& other = waves.labels[carrier.number(carrier.across(carrier.opposite(in)))];
    if (other.start == no_index || other.start == label.start) continue;
    note(result, label.start, other.start,
         label.cost + other.cost - carrier.crossing(carrier.across(in)));
  }
  return result;
}

/// Cancels as cancel_position_singularities() does, all that is cheap enough, step by step.
class Cancelling {
 public:
  Cancelling(LatticeMesh& lattice, float radius)
      : lattice_(lattice),
        radius_(radius),
        carrier_(lattice, Context()),
        labels_(carrier_.states()),
        waves_(UnitWaves(carrier_, radius, labels_, piece(0, 1))) {}

  void start_all() {
    for (const Index h : singular_triangles(lattice_)) start(h);
    grow();
  }
  /// The same, a little farther each time.
  void start_all_slowly() {
    waves_->set_reach(0.1f);
    for (const Index h : singular_triangles(lattice_)) start(h);
    for (float reach = 0.5f; !waves_->are_grown(); reach *= 1.5f) {
      waves_->set_reach(reach);
      grow();
    }
  }
  /// The same, within pieces first.
  void start_all_in_pieces(std::uint32_t pieces) {
    std::vector<UnitWaves> waves;
    std::uint32_t first = 0;  // of the waves of a piece
    for (std::uint32_t k = 0; k < pieces; ++k) {
      const UnitWaves::Piece triangles = piece(k, pieces);
      waves.emplace_back(carrier_, radius_, labels_, triangles);
      const std::size_t started = starts_.size();
      for (const Index h : singular_triangles(lattice_)) {
        const std::uint32_t t = UnitCarrier::triangle(carrier_.state(h, 0));
        if (t < triangles.begin || t >= triangles.end) continue;
        waves[k].start(h);
        starts_.push_back(h);
      }
      std::vector<Meeting> meetings;
      waves[k].grow(meetings, Context());
      for (Meeting& meeting : meetings) {
        meeting.wave += first;
        if (meeting.other != no_index) meeting.other += first;
        meetings_.push_back(meeting);
      }
      first += static_cast<std::uint32_t>(starts_.size() - started);
    }
    waves_.emplace(waves, Context());
    grow();
  }
  const std::vector<Index>& waves() const { return starts_; }

  /// Returns false if no more waves meet.
  bool cancel_cheapest() {
    while (true) {
      const Meeting* best = nullptr;
      for (const Meeting& meeting : meetings_) {
        if (waves_->ends(meeting) && (best == nullptr || meeting.cost < best->cost))
          best = &meeting;
      }
      if (best == nullptr) return false;
      const Meeting meeting = *best;
      meetings_.erase(meetings_.begin() + (best - meetings_.data()));
      const UnitWaves::Ends ends = *waves_->ends(meeting);
      std::vector<State> steps = waves_->way(meeting.here);
      if (meeting.there != no_index) {
        const std::vector<State> others = waves_->way(meeting.there);
        if (others.empty()) continue;
        steps.insert(steps.end(), others.begin() + 1, others.end());
      }
      if (steps.empty() || !follow(steps)) continue;
      for (const Index h : {ends.from, ends.to}) {
        if (h != no_index) take_back(h);
      }
      for (const Index h : {ends.from, ends.to}) {
        if (h != no_index && is_singular(lattice_, h)) start(h);
      }
      grow();
      return true;
    }
  }

  void take_back(Index h) {
    waves_->take_back(h);
    std::erase(starts_, h);
  }
  void start(Index h) {
    waves_->start(h);
    starts_.push_back(h);
  }

  /// Until all that is known stands.
  void grow() {
    for (bool again = true; again;) {
      waves_->grow(meetings_, Context());
      again = false;
      for (std::size_t k = meetings_.size(); k-- > 0;) {
        if (waves_->ends(meetings_[k])) continue;
        waves_->meet_again(meetings_[k]);
        meetings_.erase(meetings_.begin() + static_cast<std::ptrdiff_t>(k));
        again = true;
      }
    }
  }

  /// That all is as if waves had started now.
  void expect_fresh() const {
    const UnitCarrier fresh(lattice_, Context());
    const SlowWaves slow(fresh, starts_, radius_);
    std::size_t wrong = 0;
    for (std::uint32_t number = 0; number < slow.labels.size(); ++number) {
      const auto& [cost, start] = slow.labels[number];
      const State state = fresh.state(number);
      const bool exists = state.unit < fresh.units() && fresh.halfedge(state) != no_index;
      if (!exists) continue;
      // Waves tell what has come to a state only to those who know what it costs.
      const auto ends =
          waves_->ends({number, no_index, cost, 0, cost + fresh.ending(state), 0, no_index});
      if (start == no_index) {
        wrong += !ends;
      } else if (!ends || ends->from != start) {
        ++wrong;
      } else {
        expect_leads_there(waves_->way(number), cost);
      }
    }
    EXPECT_EQ(wrong, 0u);
    expect_meetings(meetings_of(slow, fresh));
  }

 private:
  UnitWaves::Piece piece(std::uint32_t k, std::uint32_t pieces) const {
    const auto all = static_cast<std::uint32_t>(carrier_.triangles());
    return {all * k / pieces, all * (k + 1) / pieces};
  }

  void expect_meetings(const Costs& expected) const {
    Costs told;
    for (const Meeting& meeting : meetings_) {
      if (const auto ends = waves_->ends(meeting)) note(told, ends->from, ends->to, meeting.cost);
    }
    EXPECT_EQ(told.size(), expected.size());
    for (const auto& [pair, cost] : expected) {
      const auto it = told.find(pair);
      if (it == told.end()) {
        ADD_FAILURE() << pair.first << " and " << pair.second << " meet";
      } else {
        EXPECT_NEAR(it->second, cost, 1e-3) << pair.first << " " << pair.second;
      }
    }
  }

  void expect_leads_there(const std::vector<State>& way, float expected) const {
    ASSERT_FALSE(way.empty());
    float cost = carrier_.leaving(way.back());
    for (std::size_t k = way.size() - 1; k-- > 0;) {
      const State in = carrier_.across(way[k + 1]);
      const State next = carrier_.along(in), last = carrier_.along(next);
      const std::uint32_t number = carrier_.number(way[k]);
      ASSERT_TRUE(number == carrier_.number(next) || number == carrier_.number(last));
      cost += carrier_.passing(in)[number == carrier_.number(next) ? 0 : 1];
    }
    EXPECT_EQ(cost, expected);
  }

  bool follow(const std::vector<State>& steps) {
    for (std::size_t k = 0; k < steps.size(); ++k) {
      if (carrier_.may_leave(steps[k])) {
        carry(steps[k]);
        continue;
      }
      while (k-- > 0) carry(carrier_.opposite(steps[k]));
      return false;
    }
    for (const State& step : steps) {
      const Index h = carrier_.halfedge(step);
      for (const Index side : {h, PolygonMap::twin(h)}) {
        if (!lattice_.holes[side]) carrier_.look_again(side);
      }
    }
    for (const State& step : steps) {
      const Index h = carrier_.halfedge(step);
      for (const Index side : {h, PolygonMap::twin(h)}) {
        if (!lattice_.holes[side]) waves_->look_again(side);
      }
    }
    return true;
  }
  void carry(const State& step) { lattice_.set_jump(carrier_.halfedge(step), carrier_.left(step)); }

  LatticeMesh& lattice_;
  float radius_;
  UnitCarrier carrier_;
  std::vector<UnitWaves::Label> labels_;
  std::optional<UnitWaves> waves_;
  std::vector<Index> starts_;
  std::vector<Meeting> meetings_;
};

constexpr float radius = 16;

TEST(UnitWaves, GrowAsShortestPaths) {
  for (Case& c : with_creases()) {
    SCOPED_TRACE(c.name);
    Cancelling cancelling(c.lattice, radius);
    cancelling.start_all();
    EXPECT_GT(cancelling.waves().size(), 5u);
    cancelling.expect_fresh();
  }
}

TEST(UnitWaves, ComeAsFarInSteps) {
  for (Case& c : with_creases()) {
    SCOPED_TRACE(c.name);
    Cancelling cancelling(c.lattice, radius);
    cancelling.start_all_slowly();
    cancelling.expect_fresh();
  }
}

/// Also where a wave of another piece is nearer than one of its own.
TEST(UnitWaves, GoOnOverTheBordersOfPieces) {
  for (Case& c : with_creases()) {
    for (const std::uint32_t pieces : {2u, 5u}) {
      SCOPED_TRACE(c.name + ", pieces: " + std::to_string(pieces));
      Cancelling cancelling(c.lattice, radius);
      cancelling.start_all_in_pieces(pieces);
      cancelling.expect_fresh();
    }
    SCOPED_TRACE(c.name + ", with changes");
    Cancelling cancelling(c.lattice, radius);
    cancelling.start_all_in_pieces(3);
    while (cancelling.cancel_cheapest()) cancelling.expect_fresh();
  }
}

/// Each drives others away, with the places where they met.
TEST(UnitWaves, MayStartOneByOne) {
  for (Case& c : with_creases()) {
    SCOPED_TRACE(c.name);
    Cancelling cancelling(c.lattice, radius);
    for (const Index h : singular_triangles(c.lattice)) {
      SCOPED_TRACE(h);
      cancelling.start(h);
      cancelling.grow();
      cancelling.expect_fresh();
    }
  }
}

/// Others come there, and go when it starts again.
TEST(UnitWaves, LeaveNothingBehindWhenTakenBack) {
  for (Case& c : with_creases()) {
    SCOPED_TRACE(c.name);
    Cancelling cancelling(c.lattice, radius);
    cancelling.start_all();
    for (const Index h : std::vector<Index>(cancelling.waves())) {
      SCOPED_TRACE(h);
      cancelling.take_back(h);
      cancelling.grow();
      cancelling.expect_fresh();
      cancelling.start(h);
      cancelling.grow();
    }
    cancelling.expect_fresh();
  }
}

TEST(UnitWaves, AreAfterChangesAsIfTheyHadJustStarted) {
  for (Case& c : with_creases()) {
    SCOPED_TRACE(c.name);
    Cancelling cancelling(c.lattice, radius);
    cancelling.start_all();
    int changes = 0;
    while (cancelling.cancel_cheapest()) {
      SCOPED_TRACE(++changes);
      cancelling.expect_fresh();
    }
    EXPECT_GT(changes, 10);
  }
}

/// With a low bound the mesh is cut into pieces. What lies on both sides of a border must
/// go too.
TEST(CancelPositionSingularities, LeavesNothingThatIsCheapEnough) {
  constexpr CancellingCost most{2, 2};
  std::size_t gone = 0;
  for (const Case& c : closed_and_open()) {
    SCOPED_TRACE(c.name);
    LatticeMesh once = c.lattice;
    cancel_position_singularities(once, most, Context(), 1);
    gone += singular_triangles(c.lattice).size() - singular_triangles(once).size();
    LatticeMesh twice = once;
    cancel_position_singularities(twice, most, Context(), 1);
    EXPECT_EQ(twice.jumps, once.jumps);
  }
  EXPECT_GT(gone, 10u);
}

/// Ways may lead through there, but none begins or ends.
TEST(CancelPositionSingularities, LeavesThoseThatAreKept) {
  constexpr CancellingCost dear{50, 50};
  const Mesh shape = closed_shape();
  std::vector<std::uint8_t> keeps(shape.positions.size());
  for (std::size_t v = 0; v < keeps.size(); ++v) keeps[v] = shape.positions[v].x() < 0;
  for (const int posy : {4, 6}) {
    SCOPED_TRACE(posy);
    LatticeMesh some = lattice_of(shape, posy, keeps), none = lattice_of(shape, posy);
    const std::vector<Index> before = singular_triangles(some);
    ASSERT_EQ(before, singular_triangles(none));
    cancel_position_singularities(some, dear, Context());
    cancel_position_singularities(none, dear, Context());
    std::size_t kept = 0, others = 0, gone = 0;
    for (const Index h : before) {
      if (some.keeps_singularity(h)) {
        ++kept;
        EXPECT_TRUE(is_singular(some, h));
        gone += !is_singular(none, h);
      } else {
        others += !is_singular(some, h);
      }
    }
    EXPECT_GT(kept, 5u);
    EXPECT_GT(gone, kept / 2);
    EXPECT_GT(others, 5u);
  }
}

TEST(CancelPositionSingularities, DoesNotDependOnThreads) {
  for (const Case& c : with_creases()) {
    SCOPED_TRACE(c.name);
    LatticeMesh one = c.lattice;
    cancel_position_singularities(one, {2, 2}, Context(1), 1);
    for (const int threads : {2, 3, 8}) {
      LatticeMesh many = c.lattice;
      cancel_position_singularities(many, {2, 2}, Context(threads), 1);
      EXPECT_EQ(many.jumps, one.jumps);
    }
  }
}

}  // namespace
}  // namespace meshgrain
