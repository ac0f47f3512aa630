#include "finish/untangle.h"

#include <algorithm>
#include <array>
#include <utility>

#include "finish/crossings.h"
#include "finish/local_search.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

void sort_unique(std::vector<Index>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

class Untangling {
 public:
  Untangling(Extraction& extraction, const VertexFaces& around, Placement& placement,
             const Context& context)
      : faces_(extraction.mesh.faces),
        mesh_(extraction.mesh),
        around_(around),
        placement_(placement),
        context_(context),
        search_(extraction, around, placement) {}

  void mend_faces() {
    improve_bad_faces();
    if (release_vertices()) improve_bad_faces();  // a face before a feature
  }

  void part_crossings() {
    constexpr int rounds = 4;
    // Crossings of one place are parted together, or not at all.
    UnionFind places(faces_.size());
    std::vector<LocalSearch::Place> before;
    std::vector<float> quality;
    for (int round = 0; round < rounds; ++round) {
      const std::vector<Crossing> crossings = find_crossings(mesh_, context_);
      if (crossings.empty()) break;
      if (round == 0) {
        for (Index v = 0; v < mesh_.positions.size(); ++v) before.push_back(search_.place(v));
        for (Index f = 0; f < faces_.size(); ++f) quality.push_back(search_.quality(f));
      }
      for (const auto& [f, g] : crossings) {
        for (const Index near : faces_around(f)) places.unite(f, near);
        for (const Index near : faces_around(g)) places.unite(f, near);
      }
      std::vector<Index> size(faces_.size(), 0);
      for (Index f = 0; f < faces_.size(); ++f) ++size[places.find(f)];
      std::vector<Index> vertices;
      std::vector<std::array<Index, 2>> rivals;
      for (const auto& [f, g] : crossings) {
        if (size[places.find(f)] > largest_place) continue;
        const std::vector<Index> here = faces_around(f), there = faces_around(g);
        for (const Index a : here) {
          for (const Index b : there) {
            rivals.push_back({a, b});
            rivals.push_back({b, a});
          }
        }
        for (const auto* list : {&here, &there}) {
          for (const Index face : *list) {
            vertices.insert(vertices.end(), faces_[face].begin(), faces_[face].end());
          }
        }
      }
      search_.keep_apart(std::move(rivals));
      sort_unique(vertices);
      for (const Index v : vertices) search_.touch(v);
      search_.improve(vertices, context_);
    }
    if (before.empty()) return;
    search_.keep_apart({});
    std::vector<std::uint8_t> failed(faces_.size(), 0);
    for (const auto& [f, g] : find_crossings(mesh_, context_)) {
      failed[places.find(f)] = failed[places.find(g)] = 1;
    }
    for (Index f = 0; f < faces_.size(); ++f) {
      const float now = search_.quality(f);
      if (now < acceptable && now < quality[f]) failed[places.find(f)] = 1;
    }
    for (Index f = 0; f < faces_.size(); ++f) {
      if (!failed[places.find(f)]) continue;
      for (const Index v : faces_[f]) search_.put(v, before[v]);
    }
  }

 private:
  using Crossing = std::array<Index, 2>;

  static constexpr float wanted = 0.75f;      // quality below which a face is looked at
  static constexpr float acceptable = 0.15f;  // below which its vertices leave their features
  // Faces that cross in a larger place do so because the surface itself does.
  static constexpr Index largest_place = 150;

  std::vector<Index> faces_around(Index f) const {
    std::vector<Index> result;
    for (const Index v : faces_[f]) {
      result.insert(result.end(), around_[v].begin(), around_[v].end());
    }
    sort_unique(result);
    return result;
  }

  void improve_bad_faces() {
    constexpr int rounds = 10;
    std::vector<Index> before;
    for (int round = 0; round < rounds; ++round) {
      std::vector<Index> vertices;
      for (Index f = 0; f < faces_.size(); ++f) {
        if (search_.quality(f) >= wanted) continue;
        for (const Index g : faces_around(f)) {  // the neighbours must make room
          vertices.insert(vertices.end(), faces_[g].begin(), faces_[g].end());
        }
      }
      sort_unique(vertices);
      if (vertices == before) return;
      search_.improve(vertices, context_);
      before = std::move(vertices);
    }
  }

  bool release_vertices() {
    bool any = false;
    for (Index f = 0; f < faces_.size(); ++f) {
      if (search_.quality(f) >= acceptable) continue;
      for (const Index v : faces_[f]) {
        if (!placement_.release(v)) continue;
        search_.touch(v);
        any = true;
      }
    }
    return any;
  }

  const Faces& faces_;
  const Mesh& mesh_;
  const VertexFaces& around_;
  Placement& placement_;
  const Context& context_;
  LocalSearch search_;
};

}  // namespace

void untangle(Extraction& extraction, const VertexFaces& around, Placement& placement,
              const Context& context) {
  Untangling untangling(extraction, around, placement, context);
  untangling.mend_faces();
  untangling.part_crossings();
}

}  // namespace meshgrain
