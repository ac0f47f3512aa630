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

  /// With as many rings of faces around the bad ones as it takes.
  void run() {
    for (const int rings : {2, 3, 5}) {
      const Pairs bad = find_bad();
      if (bad.empty()) return;
      const std::vector<Place> places = find_places(bad, rings);
      for (const Place& place : places) {
        context_.check();
        if (!mend(place)) restore(place);
      }
      search_.keep_apart({});
      restore_crossing(places);
    }
  }

 private:
  using Pairs = std::vector<std::array<Index, 2>>;

  /// Bad faces, with some rings of others, and how they were. Places have no face in common.
  struct Place {
    std::vector<Index> faces;     // in order
    std::vector<Index> vertices;  // those with all of their faces in it
    std::vector<LocalSearch::Place> before;
    float worst = 1;  // quality of the faces
  };

  // Larger places, in faces, are left alone; where the surface itself crosses even sooner.
  static constexpr std::size_t largest_place = 500, largest_inherent = 100;

  /// Pairs of faces that pass through each other; those that are turned over with themselves.
  Pairs find_bad() const {
    Pairs bad = find_crossings(mesh_, context_);
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      if (search_.quality(f) <= 0) bad.push_back({f, f});
    }
    return bad;
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
      place.worst = worst(place);
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

  bool crosses(const Place& place) const {
    for (std::size_t i = 0; i < place.faces.size(); ++i) {
      for (std::size_t j = i + 1; j < place.faces.size(); ++j) {
        if (penetration(mesh_, place.faces[i], place.faces[j]) > 0) return true;
      }
    }
    return false;
  }

  bool is_mended(const Place& place) const {
    constexpr float acceptable = 0.1f, least = 0.01f;
    return worst(place) >= std::clamp(place.worst, least, acceptable) && !crosses(place);
  }

  bool mend(const Place& place) {
    const bool inherent = surface_crosses(place);
    if (inherent && place.faces.size() > largest_inherent) return false;
    if (slide(place)) return true;
    if (inherent) return false;
    restore(place);
    if (loosen(place, false) || slide(place)) return true;
    restore(place);
    return slide(place) || loosen(place, true);
  }

  /// Takes back what has come upon something beyond its place.
  void restore_crossing(const std::vector<Place>& places) {
    std::vector<Index> crossing;
    for (const auto& [f, g] : find_crossings(mesh_, context_)) {
      crossing.push_back(f);
      crossing.push_back(g);
    }
    for (const Place& place : places) {
      if (std::any_of(crossing.begin(), crossing.end(), [&](Index f) {
            return std::binary_search(place.faces.begin(), place.faces.end(), f);
          })) {
        restore(place);
      }
    }
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
    constexpr int sweeps = 30;
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
