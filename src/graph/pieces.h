#pragma once

#include "meshgrain/context.h"
#include "meshgrain/graph.h"
#include "util/indices.h"
#include "util/union_find.h"

namespace meshgrain {

/// The nodes of each piece of a graph that hangs together, as one set.
inline SharedUnionFind pieces_of(const Graph& graph, const Context& context) {
  SharedUnionFind pieces(graph.size());
  const auto unite_neighbors = [&](Index i) {
    for (const Index j : graph.neighbors_of(i)) {
      if (i < j) pieces.unite(i, j);
    }
  };
  for_indices(graph.size(), unite_neighbors, context);
  return pieces;
}

}  // namespace meshgrain
