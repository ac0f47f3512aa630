#include "extract/knot_search.h"

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <tuple>
#include <utility>

#include "util/edge_of.h"
#include "util/hash.h"

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
    int sum = 0;  // of squares
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

  int excess(const PolygonMap& map, Index v) const {
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
      const int e = excess(map, v);
      state.sum += square(e);
      state.irregular += e != 0;
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
    const auto& [parts, repair] = *state.changed;
    const PolygonMap& map = parts.map;
    std::vector<int> excess_of(beyond_.size());
    for (Index v = 0; v < excess_of.size(); ++v) excess_of[v] = excess(map, v);
    const auto is_quad = [&, &repair = repair](Index h) {
      return !repair.is_hole(h) && map.degree(h) == 4;
    };
    const auto gain = [&](Index v, int change) {
      return square(excess_of[v] + change) - square(excess_of[v]);
    };
    const auto add = [&](int change, const KnotStep& step) {
      out.push_back({state.sum + change, number, step});
    };
    const Clusters& clusters = parts.clusters;
    const auto is_loose = [&](Index v) {
      return !clusters.on_border[v] && clusters.hold[v] == free_vertex;
    };
    const bool may_close = state.closed < most_;
    for (Index h = 0; h < map.halfedges(); ++h) {
      if (map.removed(h) || !is_quad(h)) continue;
      const Index across = map.next(map.next(h)), t = PolygonMap::twin(h);
      const Index a = map.origin(h), b = map.target(h), c = map.origin(across),
                  d = map.target(across);
      const bool is_same = across < h && is_loose(a);  // as closing the quad of `across`
      if (!is_same && is_loose(c) && may_close && excess_of[b] >= 0 && excess_of[d] >= 0 &&
          any_irregular(excess_of, {a, b, c, d})) {
        // One vertex has the edges of both, but for two that they share.
        const int merged =
            square(excess_of[a] + excess_of[c] + 2) - square(excess_of[a]) - square(excess_of[c]);
        add(merged + gain(b, -1) + gain(d, -1), {h});
      }
      if (h > t || !is_quad(t)) continue;
      if (excess_of[a] < 0 || excess_of[b] < 0) continue;
      // The corners of both quads, from the target of h on.
      const Index beyond = map.next(t);
      const Index corners[6] = {b, c, d, a, map.target(beyond), map.target(map.next(beyond))};
      for (const int from : {1, 2}) {
        const Index p = corners[from], q = corners[from + 3];
        if (!any_irregular(excess_of, {a, b, p, q})) continue;
        add(gain(a, -1) + gain(b, -1) + gain(p, 1) + gain(q, 1), {h, from});
      }
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
