#include "finish/part_crossings.h"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "finish/crossings.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

void sort_unique(std::vector<Index>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

class Parting {
 public:
  Parting(const Mesh& mesh, const VertexFaces& around, LocalSearch& search, const Context& context)
      : mesh_(mesh), around_(around), search_(search), context_(context) {}

  void run() {
    const auto crossings = find_crossings(mesh_, context_);
    if (crossings.empty()) return;
    std::vector<Place> places = find_places(crossings);
    for (Place& place : places) {
      context_.check();
      slide(place);
      if (is_mended(place)) continue;
      restore(place);
      loosen(place);
      if (!is_mended(place)) restore(place);
    }
    search_.keep_apart({});
    // What has moved may have come upon something else.
    const auto left = find_crossings(mesh_, context_);
    for (const Place& place : places) {
      const auto holds = [&](Index f) {
        return std::binary_search(place.faces.begin(), place.faces.end(), f);
      };
      const bool crosses =
          std::any_of(left.begin(), left.end(), [&](const auto& c) { return holds(c[0]); }) ||
          std::any_of(left.begin(), left.end(), [&](const auto& c) { return holds(c[1]); });
      if (crosses) restore(place);
    }
  }

 private:
  /// Faces that cross, with two rings of others, and how they were. Places have no face in common.
  struct Place {
    std::vector<Index> faces;     // in order
    std::vector<Index> vertices;  // those with all of their faces in it
    std::vector<LocalSearch::Place> before;
    float worst = 1;  // quality of the faces
  };

  // Faces cross in a larger place because the surface itself does.
  static constexpr std::size_t largest_place = 250;

  std::vector<Place> find_places(const std::vector<std::array<Index, 2>>& crossings) {
    UnionFind sets(mesh_.faces.size());
    std::vector<Index> involved;
    for (const auto& [f, g] : crossings) {
      std::vector<Index> faces{f, g};
      constexpr int rings = 2;
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
      sort_unique(place.vertices);
      for (const Index v : place.vertices) place.before.push_back(search_.place(v));
      place.worst = worst(place);
      places.push_back(std::move(place));
    }
    return places;
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
    constexpr float acceptable = 0.15f;
    return worst(place) >= std::min(place.worst, acceptable) && !crosses(place);
  }

  void restore(const Place& place) {
    for (std::size_t k = 0; k < place.vertices.size(); ++k) {
      search_.put(place.vertices[k], place.before[k]);
    }
  }

  /// Over the surface.
  void slide(const Place& place) {
    search_.keep_apart(place.faces);
    for (const Index v : place.vertices) search_.touch(v);
    search_.improve(place.vertices, context_);
  }

  /// Off the surface: each vertex towards its neighbours, until nothing crosses.
  void loosen(const Place& place) {
    constexpr int steps = 12;
    for (int step = 0; step < steps && !is_mended(place); ++step) {
      std::vector<Vec3> next;
      for (const Index v : place.vertices) {
        Vec3 sum = Vec3::Zero();
        float count = 0;
        for (const Index f : around_[v]) {
          for (const Index w : mesh_.faces[f]) {
            if (w == v) continue;
            sum += mesh_.positions[w];
            ++count;
          }
        }
        next.push_back(0.5f * (mesh_.positions[v] + sum / count));
      }
      for (std::size_t k = 0; k < place.vertices.size(); ++k) {
        search_.put(place.vertices[k], {next[k], place.before[k].seed});
      }
    }
  }

  const Mesh& mesh_;
  const VertexFaces& around_;
  LocalSearch& search_;
  const Context& context_;
};

}  // namespace

void part_crossings(const Mesh& mesh, const VertexFaces& around, LocalSearch& search,
                    const Context& context) {
  Parting(mesh, around, search, context).run();
}

}  // namespace meshgrain
