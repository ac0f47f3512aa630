#include "mesh/join_edges.h"

#include <algorithm>
#include <vector>

#include "util/sort_unique.h"

namespace meshgrain {
namespace {

class Joining {
 public:
  Joining(std::span<const std::array<Index, 2>> edges, std::size_t count) : offsets_(count + 1, 0) {
    std::vector<std::array<Index, 2>> ways;
    for (const auto& [a, b] : edges) {
      if (a != b) ways.insert(ways.end(), {{a, b}, {b, a}});
    }
    sort_unique(ways);
    for (const auto& way : ways) {
      ++offsets_[way[0] + 1];
      spokes_.push_back({way[1], false});
    }
    for (std::size_t v = 0; v < count; ++v) offsets_[v + 1] += offsets_[v];
  }

  Polylines run() {
    const auto count = static_cast<Index>(offsets_.size() - 1);
    for (Index v = 0; v < count; ++v) {
      if (degree(v) != 2) follow_all(v);
    }
    for (Index v = 0; v < count; ++v) follow_all(v);  // what is closed
    return std::move(lines_);
  }

 private:
  struct Spoke {
    Index to;
    bool done;
  };

  Index degree(Index v) const { return offsets_[v + 1] - offsets_[v]; }

  Spoke& spoke(Index from, Index to) {
    const auto begin = spokes_.begin() + offsets_[from], end = spokes_.begin() + offsets_[from + 1];
    return *std::find_if(begin, end, [&](const Spoke& s) { return s.to == to; });
  }

  void follow_all(Index v) {
    for (Index s = offsets_[v]; s < offsets_[v + 1]; ++s) {
      if (!spokes_[s].done) follow(v, spokes_[s].to);
    }
  }

  void follow(const Index start, Index to) {
    lines_.vertices.push_back(start);
    for (Index at = start;;) {
      spoke(at, to).done = spoke(to, at).done = true;
      lines_.vertices.push_back(to);
      if (to == start || degree(to) != 2) break;
      const Index first = offsets_[to];
      const Index next = spokes_[spokes_[first].to == at ? first + 1 : first].to;
      at = to;
      to = next;
    }
    lines_.starts.push_back(static_cast<Index>(lines_.vertices.size()));
  }

  std::vector<Index> offsets_;
  std::vector<Spoke> spokes_;
  Polylines lines_;
};

}  // namespace

Polylines join_edges(std::span<const std::array<Index, 2>> edges, std::size_t count) {
  return Joining(edges, count).run();
}

}  // namespace meshgrain
