#include "field/bending.h"

#include "field/bend_patch.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 2048;

/// Means of each node and its neighbours.
void even_out(const Graph& graph, std::vector<float>& values, const Context& context) {
  std::vector<float> next(values.size());
  context.for_ranges(values.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      float sum = values[i];
      for (const Index j : graph.neighbors_of(i)) sum += values[j];
      next[i] = sum / static_cast<float>(1 + graph.neighbors_of(i).size());
    }
  });
  values.swap(next);
}

}  // namespace

std::vector<float> bending(const Hierarchy& hierarchy, const Mesh& surface,
                           const FeatureLines& creases, double area, const Context& context) {
  const VertexFaces around =
      are_vertices(hierarchy, surface) ? vertex_faces(surface, context) : VertexFaces();
  const BendPatches patches(hierarchy, surface, around, creases, context);
  std::size_t level = level_of_area(hierarchy, area);
  const Graph& graph = hierarchy.levels[level];
  std::vector<BendPatch> own(graph.size());
  context.for_ranges(own.size(), grain, [&](std::size_t begin, std::size_t end) {
    context.check();
    for (auto i = static_cast<Index>(begin); i < end; ++i) own[i] = patches.of(level, i);
  });
  std::vector<float> result(own.size());
  const auto measure = [&](Index i) { result[i] = with_neighbors(graph, own, i).norm(); };
  for_indices(own.size(), measure, context);

  // And down again, evened out on each level.
  for (; level > 0; --level) {
    const std::vector<Index>& parents = hierarchy.parents[level - 1];
    std::vector<float> finer(parents.size());
    for (std::size_t i = 0; i < finer.size(); ++i) finer[i] = result[parents[i]];
    result.swap(finer);
    even_out(hierarchy.levels[level - 1], result, context);
  }
  return result;
}

}  // namespace meshgrain
