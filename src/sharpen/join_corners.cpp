#include "sharpen/join_corners.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "mesh/border.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/clean.h"
#include "sharpen/noisy_lines.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

/// The edges of one round of contractions, none beside another.
class Contraction {
 public:
  Contraction(const Mesh& mesh, const Context& context)
      : mesh_(mesh), around_(vertex_faces(mesh, context)), taken_(mesh.positions.size(), 0) {
    for (const auto& ends : rim_edges(mesh, context)) {
      for (const Index v : ends) taken_[v] = 1;
    }
    into_.resize(mesh.positions.size());
    std::iota(into_.begin(), into_.end(), Index{0});
  }

  /// Returns whether the edge can be contracted in this round.
  bool add(Index a, Index b) {
    const std::vector<Index> near_a = neighbors(a), near_b = neighbors(b);
    std::vector<Index> all;
    std::ranges::set_union(near_a, near_b, std::back_inserter(all));
    // Two common neighbours, besides the two themselves: the link condition.
    if (near_a.size() + near_b.size() - all.size() != 2 + 2) return false;
    if (std::ranges::any_of(all, [&](Index v) { return taken_[v]; })) return false;
    for (const Index v : all) taken_[v] = 1;
    into_[b] = a;
    return true;
  }

  Index into(Index v) const { return into_[v]; }

 private:
  /// Sorted, and the vertex itself.
  std::vector<Index> neighbors(Index v) const {
    std::vector<Index> result;
    for (const Index f : around_[v]) {
      result.insert(result.end(), mesh_.faces[f].begin(), mesh_.faces[f].end());
    }
    sort_unique(result);
    return result;
  }

  const Mesh& mesh_;
  VertexFaces around_;
  std::vector<std::uint8_t> taken_;
  std::vector<Index> into_;
};

}  // namespace

void join_near_corners(Mesh& mesh, double distance, const Context& context) {
  constexpr int rounds = 20;
  for (int round = 0; round < rounds; ++round) {
    Contraction contraction(mesh, context);
    const FeatureLines lines = noisy_lines(mesh, distance);
    bool any = false;
    for (std::size_t line = 0; line < lines.size(); ++line) {
      if (lines.is_closed(line)) continue;
      const Index first = lines.begin(line), last = lines.end(line) - 1;
      double length = 0;
      for (Index k = first; k < last; ++k) {
        length += (lines.positions[k + 1] - lines.positions[k]).norm();
      }
      if (length >= distance) continue;
      const Index a = lines.vertices[first], b = lines.vertices[first + 1];
      if (!contraction.add(a, b)) continue;
      mesh.positions[a] = (mesh.positions[a] + mesh.positions[b]) / 2;
      any = true;
    }
    if (!any) return;
    for (Index& v : mesh.faces.corners()) v = contraction.into(v);
    for (auto& edge : mesh.marked_edges) {
      for (Index& v : edge) v = contraction.into(v);
    }
    clean(mesh);
  }
}

}  // namespace meshgrain
