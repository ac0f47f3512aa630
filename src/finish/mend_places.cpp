#include "finish/mend_places.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "finish/crossings.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

void sort_unique(std::vector<Index>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

class Mending {
 public:
  Mending(const Mesh& mesh, const VertexFaces& around, const Placement& placement,
          LocalSearch& search, const Context& context)
      : mesh_(mesh), around_(around), placement_(placement), search_(search), context_(context) {}

  void run() {
    // With as many rings of faces around the bad ones as it takes.
    for (const int rings : {2, 3, 5}) {
      const Pairs crossings = find_crossings(mesh_, context_);
      if (crossings.empty()) break;
      std::vector<Place> places = find_places(crossings, rings);
      for (Place& place : places) {
        place.needed = std::clamp(worst(place), 0.01f, acceptable);
      }
      mend(places, [&](const Place& place) { return part(place); });
    }
    for (const int rings : {2, 3, 5}) {
      Pairs bad;
      for (Index f = 0; f < mesh_.faces.size(); ++f) {
        if (search_.quality(f) < acceptable) bad.push_back({f, f});
      }
      if (bad.empty()) return;
      std::vector<Place> places = find_places(bad, rings);
      const std::vector<std::size_t> crossings = count_crossings(places);
      for (std::size_t k = 0; k < places.size(); ++k) {
        places[k].needed = acceptable;
        places[k].worse = count_worse(places[k]) - 1;  // to help one is good
        places[k].crossings = crossings[k];
      }
      mend(places, [&](const Place& place) { return reshape(place); });
    }
  }

 private:
  using Pairs = std::vector<std::array<Index, 2>>;

  /// Bad faces, with some rings of others, and how they were. Places have no face in common.
  struct Place {
    std::vector<Index> faces;     // in order
    std::vector<Index> vertices;  // those with all of their faces in it
    std::vector<LocalSearch::Place> before;
    float needed = 0;           // quality that faces must come to have
    std::size_t worse = 0;      // how many may stay without
    std::size_t crossings = 0;  // pairs of faces that may pass through each other
  };

  static constexpr float acceptable = 0.1f;
  // Larger places, in faces, are left alone; where the surface itself crosses even sooner.
  static constexpr std::size_t largest_place = 300, largest_inherent = 60;

  template <typename How>
  void mend(const std::vector<Place>& places, const How& how) {
    for (const Place& place : places) {
      context_.check();
      if (!how(place)) restore(place);
    }
    search_.keep_apart({});
    // What has moved may have come upon something beyond its place.
    const std::vector<std::size_t> crossings = count_crossings(places);
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (crossings[k] > places[k].crossings) restore(places[k]);
    }
  }

  bool part(const Place& place) {
    const bool inherent = surface_crosses(place);
    if (inherent && place.faces.size() > largest_inherent) return false;
    if (slide(place)) return true;
    if (inherent) return false;
    restore(place);
    if (loosen(place, false) || slide(place)) return true;
    restore(place);
    return slide(place) || loosen(place, true);
  }

  bool reshape(const Place& place) {
    if (loosen(place, false)) return true;
    restore(place);
    return loosen(place, true);
  }

  /// How many pairs of faces pass through each other of which one lies in each place.
  std::vector<std::size_t> count_crossings(const std::vector<Place>& places) const {
    const Pairs pairs = find_crossings(mesh_, context_);
    std::vector<std::size_t> result;
    for (const Place& place : places) {
      const auto holds = [&](Index f) {
        return std::binary_search(place.faces.begin(), place.faces.end(), f);
      };
      result.push_back(static_cast<std::size_t>(std::count_if(
          pairs.begin(), pairs.end(), [&](const auto& c) { return holds(c[0]) || holds(c[1]); })));
    }
    return result;
  }

  std::vector<Place> find_places(const Pairs& bad, int rings) const {
    UnionFind sets(mesh_.faces.size());
    std::vector<Index> involved;
    for (const auto& [f, g] : bad) {
      std::vector<Index> faces{f, g};
      for (int ring = 0; ring < rings; ++ring) {
        std::vector<Index> wider;
        for (const Index face : faces) {
          for (const Index v : mesh_.faces[face]) {
            wider.insert(wider.end(), around_[v].begin(), around_[v].end());
          }
        }
        sort_unique(wider);
        faces.swap(wider);
      }
      for (const Index face : faces) sets.unite(f, face);
      involved.insert(involved.end(), faces.begin(), faces.end());
    }
    sort_unique(involved);
    std::map<Index, Place> by_root;
    for (const Index f : involved) by_root[sets.find(f)].faces.push_back(f);
    std::vector<Place> places;
    for (auto& [root, place] : by_root) {
      if (place.faces.size() > largest_place) continue;
      for (const Index f : place.faces) {
        for (const Index v : mesh_.faces[f]) {
          const auto around = around_[v];
          if (std::all_of(around.begin(), around.end(),
                          [&](Index g) { return sets.find(g) == root; })) {
            place.vertices.push_back(v);
          }
        }
      }
      if (place.vertices.empty()) continue;
      sort_unique(place.vertices);
      for (const Index v : place.vertices) place.before.push_back(search_.place(v));
      places.push_back(std::move(place));
    }
    return places;
  }

  float mean_edge(const Place& place) const {
    float sum = 0, count = 0;
    for (const Index f : place.faces) {
      const auto face = mesh_.faces[f];
      for (std::size_t k = 0; k < face.size(); ++k) {
        sum += (mesh_.positions[face[k]] - mesh_.positions[face[(k + 1) % face.size()]]).norm();
        ++count;
      }
    }
    return sum / count;
  }

  bool surface_crosses(const Place& place) const {
    std::vector<Index> nodes;
    Vec3 low = place.before[0].position, high = low;
    for (const LocalSearch::Place& at : place.before) {
      nodes.push_back(at.seed.on_line != no_index ? at.seed.on_line : at.seed.node);
      low = low.cwiseMin(at.position);
      high = high.cwiseMax(at.position);
    }
    const Mesh piece = placement_.projector().cut_out(low, high, std::move(nodes));
    return !find_crossings(piece, context_).empty();
  }

  float worst(const Place& place) const {
    float least = 1;
    for (const Index f : place.faces) least = std::min(least, search_.quality(f));
    return least;
  }

  std::size_t count_worse(const Place& place) const {
    return static_cast<std::size_t>(
        std::count_if(place.faces.begin(), place.faces.end(),
                      [&](Index f) { return search_.quality(f) < place.needed; }));
  }

  bool is_mended(const Place& place) const {
    if (count_worse(place) > place.worse) return false;
    std::size_t crossings = 0;
    for (std::size_t i = 0; i < place.faces.size(); ++i) {
      for (std::size_t j = i + 1; j < place.faces.size(); ++j) {
        crossings += penetration(mesh_, place.faces[i], place.faces[j]) > 0;
      }
    }
    return crossings <= place.crossings;
  }

  void restore(const Place& place) {
    for (std::size_t k = 0; k < place.vertices.size(); ++k) {
      search_.put(place.vertices[k], place.before[k]);
    }
  }

  /// Over the surface. Returns whether the place is mended.
  bool slide(const Place& place) {
    search_.keep_apart(place.faces);
    for (const Index v : place.vertices) search_.touch(v);
    constexpr int sweeps = 10;
    search_.improve(place.vertices, sweeps, context_);
    return is_mended(place);
  }

  /// Off the surface, but not far: each vertex towards its neighbours, until nothing crosses.
  /// Returns whether that came to be. Vertices that hold an end out move only if `with_ends`.
  bool loosen(const Place& place, bool with_ends) {
    constexpr int steps = 30;
    const float farthest = mean_edge(place);
    for (int step = 0; step < steps && !is_mended(place); ++step) {
      std::vector<Vec3> next;
      for (std::size_t k = 0; k < place.vertices.size(); ++k) {
        const Index v = place.vertices[k];
        const Vec3& start = place.before[k].position;
        Vec3 sum = Vec3::Zero();
        float count = 0;
        for (const Index f : around_[v]) {
          for (const Index w : mesh_.faces[f]) {
            if (w == v) continue;
            sum += mesh_.positions[w];
            ++count;
          }
        }
        const Vec3 moved = 0.5f * (mesh_.positions[v] + sum / count) - start;
        next.push_back(start + moved * std::min(1.0f, farthest / std::max(moved.norm(), 1e-30f)));
      }
      for (std::size_t k = 0; k < place.vertices.size(); ++k) {
        if (!with_ends && placement_.is_tethered(place.vertices[k])) continue;
        search_.put(place.vertices[k], {next[k], place.before[k].seed});
      }
    }
    return is_mended(place);
  }

  const Mesh& mesh_;
  const VertexFaces& around_;
  const Placement& placement_;
  LocalSearch& search_;
  const Context& context_;
};

}  // namespace

void mend_places(const Mesh& mesh, const VertexFaces& around, const Placement& placement,
                 LocalSearch& search, const Context& context) {
  Mending(mesh, around, placement, search, context).run();
}

}  // namespace meshgrain
