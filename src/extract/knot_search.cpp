#include "extract/knot_search.h"

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <tuple>
#include <utility>

#include "util/edge_of.h"
#include "util/hash.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

// Found to be enough: wider and longer searches find hardly anything more.
constexpr std::size_t width = 16, longest = 10, results = 2;
constexpr std::size_t tries = 4;  // for each that is kept of a step: others may not be done

int square(int x) {
  return x * x;
}

bool any_irregular(const std::vector<int>& excess, const std::array<Index, 4>& vertices) {
  return std::ranges::any_of(vertices, [&](Index v) { return excess[v] != 0; });
}

class KnotSearch {
 public:
  KnotSearch(const ExtractionMap& piece, const std::vector<int>& excess, std::size_t most)
      : piece_(piece), most_(most) {
    // What each vertex has in the whole mesh and not here, less what is regular.
    for (Index v = 0; v < excess.size(); ++v) {
      beyond_.push_back(excess[v] - static_cast<int>(piece.map.valence(v)));
    }
  }

  std::vector<Untying> run(const Context& context) {
    std::vector<State> beam;
    beam.push_back(state_after({}));
    const std::size_t before = beam[0].irregular;
    seen_.insert(beam[0].hash);
    for (std::size_t length = 1; length <= longest && !beam.empty(); ++length) {
      context.check();
      beam = next(beam);
      for (const State& state : beam) {
        if (state.irregular < before) found_.push_back({state.steps, state.irregular});
      }
    }
    std::ranges::stable_sort(
        found_, {}, [](const Untying& way) { return std::pair(way.irregular, way.steps.size()); });
    if (found_.size() > results) found_.resize(results);
    return std::move(found_);
  }

 private:
  /// A piece after some steps.
  struct Changed {
    ExtractionMap parts;
    FaceRepair repair;
    Changed(const ExtractionMap& piece, std::span<const KnotStep> steps)
        : parts(piece),
          repair(parts.map, parts.clusters, 4, std::move(parts.holes), std::move(parts.lines)) {
      take_steps(repair, steps);
    }
  };

  struct State {
    std::vector<KnotStep> steps;
    std::vector<int> excess;  // of each vertex
    int sum = 0;              // of squares
    std::size_t irregular = 0, closed = 0;
    std::uint64_t hash = 0;  // of its edges
    std::unique_ptr<Changed> changed;
  };

  /// A step from a state of the beam, before it is known whether it can be done.
  struct Candidate {
    int sum;
    std::size_t state;
    KnotStep step;
    auto order() const { return std::tuple(sum, state, step.h, step.from); }
  };

  int excess_of(const PolygonMap& map, Index v) const {
    return map.leaving(v) == no_index ? 0 : static_cast<int>(map.valence(v)) + beyond_[v];
  }

  static bool may_take(const FaceRepair& repair, const KnotStep& step) {
    return step.closes() ? repair.may_close(step.h) : repair.may_turn(step.h, step.from);
  }

  State state_after(std::vector<KnotStep> steps) const {
    State state;
    state.changed = std::make_unique<Changed>(piece_, steps);
    const PolygonMap& map = state.changed->parts.map;
    for (Index v = 0; v < beyond_.size(); ++v) {
      const int excess = excess_of(map, v);
      state.excess.push_back(excess);
      state.sum += square(excess);
      state.irregular += excess != 0;
    }
    for (Index h = 0; h < map.halfedges(); h += 2) {
      if (map.removed(h)) continue;
      const auto [a, b] = edge_of(map.origin(h), map.target(h));
      state.hash += hash64(a, b);
    }
    for (const KnotStep& step : steps) state.closed += step.closes();
    state.steps = std::move(steps);
    return state;
  }

  std::vector<State> next(const std::vector<State>& beam) {
    std::vector<Candidate> candidates;
    for (std::size_t s = 0; s < beam.size(); ++s) look_around(beam[s], s, candidates);
    const std::size_t enough = std::min(candidates.size(), tries * width);
    std::ranges::partial_sort(candidates, candidates.begin() + static_cast<std::ptrdiff_t>(enough),
                              {}, &Candidate::order);
    std::vector<State> result;
    for (std::size_t k = 0; k < enough && result.size() < width; ++k) {
      const auto& [sum, s, step] = candidates[k];
      if (!may_take(beam[s].changed->repair, step)) continue;
      std::vector<KnotStep> steps = beam[s].steps;
      steps.push_back(step);
      State state = state_after(std::move(steps));
      if (seen_.insert(state.hash).second) result.push_back(std::move(state));
    }
    return result;
  }

  /// All steps that change an irregular vertex, and leave none with fewer than three edges.
  void look_around(const State& state, std::size_t number, std::vector<Candidate>& out) const {
    const auto add = [&](int gain, const KnotStep& step) {
      out.push_back({state.sum + gain, number, step});
    };
    for (const Index h : beside_irregular(state)) {
      if (state.closed < most_) look_at_closing(state, h, add);
      if (h < PolygonMap::twin(h)) look_at_turns(state, h, add);
    }
  }

  /// Both halfedges of all edges of faces with an irregular corner.
  static std::vector<Index> beside_irregular(const State& state) {
    const PolygonMap& map = state.changed->parts.map;
    std::vector<Index> found;
    for (Index v = 0; v < state.excess.size(); ++v) {
      if (state.excess[v] == 0) continue;
      map.for_each_leaving(v, [&](Index face) {
        if (state.changed->repair.is_hole(face)) return;
        map.for_orbit(face, [&](Index h) {
          found.push_back(h);
          found.push_back(PolygonMap::twin(h));
        });
      });
    }
    sort_unique(found);
    return found;
  }

  static bool is_quad(const State& state, Index h) {
    return !state.changed->repair.is_hole(h) && state.changed->parts.map.degree(h) == 4;
  }

  /// By how much the sum grows if a vertex gets so many edges more.
  static int growth(const State& state, Index v, int more) {
    return square(state.excess[v] + more) - square(state.excess[v]);
  }

  template <typename Add>
  static void look_at_closing(const State& state, Index h, const Add& add) {
    if (!is_quad(state, h)) return;
    const auto& [parts, repair] = *state.changed;
    const PolygonMap& map = parts.map;
    const Index across = map.next(map.next(h));
    const Index a = map.origin(h), b = map.target(h), c = map.origin(across),
                d = map.target(across);
    const bool is_same = across < h && repair.is_loose(a);  // as closing the quad of `across`
    const std::vector<int>& excess = state.excess;
    if (is_same || !repair.is_loose(c) || excess[b] < 0 || excess[d] < 0) return;
    if (!any_irregular(excess, {a, b, c, d})) return;
    // One vertex has the edges of both, but for two that they share.
    const int merged = square(excess[a] + excess[c] + 2) - square(excess[a]) - square(excess[c]);
    add(merged + growth(state, b, -1) + growth(state, d, -1), {h});
  }

  template <typename Add>
  static void look_at_turns(const State& state, Index h, const Add& add) {
    const PolygonMap& map = state.changed->parts.map;
    const Index t = PolygonMap::twin(h), a = map.origin(h), b = map.target(h);
    if (!is_quad(state, h) || !is_quad(state, t)) return;
    if (state.excess[a] < 0 || state.excess[b] < 0) return;
    // The corners of both quads, from the target of h on.
    const Index ahead = map.next(h), beyond = map.next(t);
    const Index corners[6] = {b, map.target(ahead),  map.target(map.next(ahead)),
                              a, map.target(beyond), map.target(map.next(beyond))};
    for (const int from : {1, 2}) {
      const Index p = corners[from], q = corners[from + 3];
      if (!any_irregular(state.excess, {a, b, p, q})) continue;
      add(growth(state, a, -1) + growth(state, b, -1) + growth(state, p, 1) + growth(state, q, 1),
          {h, from});
    }
  }

  const ExtractionMap& piece_;
  const std::size_t most_;
  std::vector<int> beyond_;
  std::set<std::uint64_t> seen_;
  std::vector<Untying> found_;
};

}  // namespace

void take_steps(FaceRepair& repair, std::span<const KnotStep> steps) {
  for (const KnotStep& step : steps) {
    if (step.closes()) {
      repair.close_quad(step.h);
    } else {
      repair.apply({.h = step.h, .from = step.from, .to = step.from + 3});
    }
  }
}

std::vector<Untying> search_knot(const ExtractionMap& piece, const std::vector<int>& excess,
                                 std::size_t most, const Context& context) {
  return KnotSearch(piece, excess, most).run(context);
}

}  // namespace meshgrain
