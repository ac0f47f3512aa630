#include "finish/fit_to_rails.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "finish/chains.h"

namespace meshgrain {
namespace {

using Stop = Chords::Stop;

/// Where the vertices of a chain go, by dynamic programming over a few places for each.
class Fit {
 public:
  Fit(Mesh& mesh, const Chords& chords, Rails& rails)
      : mesh_(mesh), chords_(chords), rails_(rails) {}

  void run();

 private:
  /// A closed chain begins where its edges lie well already.
  void begin_at_best(Chain& chain) const;

  bool is_good(const Chain& chain) const;
  void fit(Chain& chain);

  Mesh& mesh_;
  const Chords& chords_;
  Rails& rails_;
};

void Fit::run() {
  for (Chain& chain : find_chains(chords_)) {
    if (!find_stops(chain, chords_) || is_good(chain)) continue;
    if (chain.is_closed() && rails_.slides(chain.vertices.front())) begin_at_best(chain);
    fit(chain);
  }
}

void Fit::begin_at_best(Chain& chain) const {
  const std::size_t count = chain.stops.size() - 1;
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = i == 0 ? count - 1 : i - 1;
    const double worse =
        std::max(chords_.cut_off(chain.line, chain.stops[before], chain.stops[before + 1]),
                 chords_.cut_off(chain.line, chain.stops[i], chain.stops[i + 1]));
    if (worse < least) {
      least = worse;
      best = i;
    }
  }
  chain.vertices.pop_back();
  chain.stops.pop_back();
  std::rotate(chain.vertices.begin(), chain.vertices.begin() + best, chain.vertices.end());
  std::rotate(chain.stops.begin(), chain.stops.begin() + best, chain.stops.end());
  for (std::size_t i = count - best; i < count; ++i)
    chain.stops[i].way += chords_.length(chain.line);
  chain.vertices.push_back(chain.vertices[0]);
  chain.stops.push_back(
      chords_.stop_at(chain.line, chain.stops[0].way + chords_.length(chain.line)));
}

bool Fit::is_good(const Chain& chain) const {
  for (std::size_t i = 0; i + 1 < chain.stops.size(); ++i) {
    if (chords_.cut_off(chain.line, chain.stops[i], chain.stops[i + 1]) > 0) return false;
  }
  return true;
}

void Fit::fit(Chain& chain) {
  // Steps are shares of the way to the neighbour on that side, so that the order stays.
  constexpr std::array steps{0.0, -0.08, 0.08, -0.16, 0.16, -0.24, 0.24, -0.32, 0.32, -0.4, 0.4};
  constexpr double against_steps = 0.01, against_change = 0.01;  // of gaps between vertices
  struct Choice {
    Stop stop;
    double cost;  // of the chain up to here
    std::size_t before;
  };
  const auto& stops = chain.stops;
  const std::size_t count = stops.size();
  std::vector<std::vector<Choice>> choices(count);
  choices[0] = {{stops[0], 0, 0}};
  for (std::size_t i = 1; i < count; ++i) {
    const double gap = stops[i].way - stops[i - 1].way;
    for (const double step : steps) {
      const double next_gap = i + 1 < count ? stops[i + 1].way - stops[i].way : 0;
      const double to = stops[i].way + step * (step < 0 ? gap : next_gap);
      Choice choice{chords_.stop_at(chain.line, to), std::numeric_limits<double>::infinity(), 0};
      for (std::size_t j = 0; j < choices[i - 1].size(); ++j) {
        const Choice& from = choices[i - 1][j];
        const double change = (to - from.stop.way) / gap - 1;
        const double cost = from.cost + against_steps * step * step +
                            against_change * change * change +
                            chords_.cut_off(chain.line, from.stop, choice.stop);
        if (cost < choice.cost) {
          choice.cost = cost;
          choice.before = j;
        }
      }
      choices[i].push_back(choice);
      if (i + 1 == count) break;  // it stays
    }
  }
  for (std::size_t i = count - 1, best = choices[i][0].before; --i > 0;) {
    const Choice& choice = choices[i][best];
    mesh_.positions[chain.vertices[i]] = choice.stop.position;
    rails_.set_place(chain.vertices[i], choice.stop.segment);
    best = choice.before;
  }
}

}  // namespace

void fit_to_rails(Mesh& mesh, const Chords& chords, Rails& rails) {
  Fit(mesh, chords, rails).run();
}

}  // namespace meshgrain
