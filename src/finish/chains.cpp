#include "finish/chains.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace meshgrain {
namespace {

/// All vertices that come after v on one side, up to one that is fixed or to v again.
void walk(const Chords& chords, Index v, Index next, std::vector<Index>& vertices) {
  Index before = v;
  while (next != no_index && vertices.size() <= chords.vertices()) {
    vertices.push_back(next);
    if (next == v || chords.line(next) != chords.line(v)) return;
    const auto& [a, b] = chords.beside(next);
    const Index after = a == before ? b : a;
    before = std::exchange(next, after);
  }
}

Chain chain_through(const Chords& chords, Index v) {
  Chain chain{chords.line(v), {}, {}};
  walk(chords, v, chords.beside(v)[0], chain.vertices);
  const bool closed = chain.vertices.back() == v;
  if (!closed) {
    std::reverse(chain.vertices.begin(), chain.vertices.end());
    chain.vertices.push_back(v);
    walk(chords, v, chords.beside(v)[1], chain.vertices);
  } else {
    chain.vertices.insert(chain.vertices.begin(), v);
  }
  return chain;
}

}  // namespace

std::vector<Chain> find_chains(const Chords& chords) {
  std::vector<Chain> result;
  std::vector<std::uint8_t> seen(chords.vertices(), 0);
  for (Index v = 0; v < seen.size(); ++v) {
    if (chords.line(v) == no_index || chords.beside(v)[1] == no_index || seen[v]) continue;
    result.push_back(chain_through(chords, v));
    for (const Index w : result.back().vertices) seen[w] = 1;
  }
  return result;
}

bool find_stops(Chain& chain, const Chords& chords) {
  // A vertex that stays is at an end of the line; if it is not, the next one stays as well.
  const auto is_known = [&](Index v) { return chords.way(v, chain.line, 0).has_value(); };
  if (!is_known(chain.vertices.back())) chain.vertices.pop_back();
  if (!is_known(chain.vertices.front())) chain.vertices.erase(chain.vertices.begin());
  const std::size_t count = chain.vertices.size();
  if (count < 3) return false;
  std::vector<double> ways;
  double near = chords.way(chain.vertices[1], chain.line, 0).value_or(0);
  for (const Index v : chain.vertices) {
    const auto way = chords.way(v, chain.line, near);
    if (!way) return false;  // it slides no more, as around a small hole
    ways.push_back(near = *way);
  }
  if (ways.back() < ways.front()) {
    std::reverse(ways.begin(), ways.end());
    std::reverse(chain.vertices.begin(), chain.vertices.end());
  }
  if (!std::is_sorted(ways.begin(), ways.end(), std::less_equal<>())) return false;
  for (const double w : ways) chain.stops.push_back(chords.stop_at(chain.line, w));
  return true;
}

}  // namespace meshgrain
