#include "mesh/border.h"

#include <algorithm>

#include "mesh/vertex_faces.h"

namespace meshgrain {
namespace {

/// Calls `take(a, b, forth, back, out)` for every edge a < b: how many faces run from a to b, and how
/// many from b to a.
template <typename Take>
std::vector<std::array<Index, 2>> select_edges(const Mesh& mesh, const Take& take,
                                               const Context& context) {
  constexpr std::size_t grain = 4096;
  const VertexFaces around = vertex_faces(mesh, context);
  const std::size_t n = mesh.positions.size();
  std::vector<std::vector<std::array<Index, 2>>> found((n + grain - 1) / grain);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    struct Use {
      Index other;
      bool forth;
    };
    std::vector<Use> uses;
    for (std::size_t v = begin; v < end; ++v) {
      const auto a = static_cast<Index>(v);
      uses.clear();
      for (const Index f : around[v]) {
        const auto face = mesh.faces[f];
        for (std::size_t k = 0; k < face.size(); ++k) {
          const Index from = face[k], to = face[k + 1 == face.size() ? 0 : k + 1];
          if (from == a && to > a) uses.push_back({to, true});
          if (to == a && from > a) uses.push_back({from, false});
        }
      }
      std::sort(uses.begin(), uses.end(),
                [](const Use& x, const Use& y) { return x.other < y.other; });
      for (std::size_t k = 0; k < uses.size();) {
        int forth = 0, back = 0;
        const Index b = uses[k].other;
        for (; k < uses.size() && uses[k].other == b; ++k) ++(uses[k].forth ? forth : back);
        take(a, b, forth, back, found[begin / grain]);
      }
    }
  });
  std::vector<std::array<Index, 2>> result;
  for (const auto& part : found) result.insert(result.end(), part.begin(), part.end());
  return result;
}

using Edges = std::vector<std::array<Index, 2>>;

}  // namespace

std::vector<std::array<Index, 2>> border_edges(const Mesh& mesh, const Context& context) {
  return select_edges(
      mesh,
      [](Index a, Index b, int forth, int back, Edges& out) {
        if (forth + back != 1) return;
        out.push_back(forth == 1 ? std::array{a, b} : std::array{b, a});
      },
      context);
}

std::vector<std::array<Index, 2>> rim_edges(const Mesh& mesh, const Context& context) {
  return select_edges(
      mesh,
      [](Index a, Index b, int forth, int back, Edges& out) {
        if (forth != 1 || back != 1) out.push_back({a, b});
      },
      context);
}

}  // namespace meshgrain
