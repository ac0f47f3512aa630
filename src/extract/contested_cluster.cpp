#include "extract/contested_cluster.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

namespace meshgrain {
namespace {

/// A link with zero jump, between places in the list of members.
struct Merge {
  float distance;
  Index i, j;
  bool operator<(const Merge& other) const {
    return std::tie(distance, i, j) < std::tie(other.distance, other.i, other.j);
  }
};

/// Disjoint sets that can list their members.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n), next_(n), size_(n, 1) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
    std::iota(next_.begin(), next_.end(), Index{0});
  }

  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  Index size(Index root) const { return size_[root]; }

  void unite(Index a, Index b) {
    if (size_[a] < size_[b]) std::swap(a, b);
    parent_[b] = a;
    size_[a] += size_[b];
    std::swap(next_[a], next_[b]);  // joins the two rings of members
  }

  template <typename Body>
  bool any_member(Index root, const Body& body) {
    Index i = root;
    do {
      if (body(i)) return true;
      i = next_[i];
    } while (i != root);
    return false;
  }

 private:
  std::vector<Index> parent_, next_, size_;
};

}  // namespace

std::vector<Index> part_contested_cluster(const Graph& graph, std::span<const Link> links,
                                          std::span<const Vec3> points,
                                          std::span<const Index> members) {
  std::vector<Merge> merges;
  std::vector<std::array<Index, 2>> units;  // in both directions
  for (Index k = 0; k < members.size(); ++k) {
    const Index i = members[k];
    for (Index e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
      if (links[e] == Link::other || graph.neighbors[e] < i) continue;
      const Index j = graph.neighbors[e];
      const auto place = std::ranges::lower_bound(members, j);
      if (place == members.end() || *place != j) continue;
      const auto l = static_cast<Index>(place - members.begin());
      if (links[e] == Link::zero) {
        merges.push_back({(points[i] - points[j]).norm(), k, l});
      } else {
        units.push_back({k, l});
        units.push_back({l, k});
      }
    }
  }
  std::ranges::sort(units);
  std::sort(merges.begin(), merges.end());
  DisjointSets sets(members.size());
  for (const Merge& merge : merges) {
    Index a = sets.find(merge.i), b = sets.find(merge.j);
    if (a == b) continue;
    if (sets.size(a) < sets.size(b)) std::swap(a, b);
    const bool is_forbidden = sets.any_member(b, [&](Index member) {
      const auto own =
          std::ranges::equal_range(units, member, {}, [](const auto& u) { return u[0]; });
      return std::ranges::any_of(own, [&](const auto& unit) { return sets.find(unit[1]) == a; });
    });
    if (!is_forbidden) sets.unite(a, b);
  }
  std::vector<Index> first(members.size(), no_index), result(members.size());
  for (Index k = 0; k < members.size(); ++k) {
    Index& part = first[sets.find(k)];
    if (part == no_index) part = members[k];
    result[k] = part;
  }
  return result;
}

}  // namespace meshgrain
