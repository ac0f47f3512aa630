#include "sharpen/noisy_lines.h"

#include "features/chain_edges.h"
#include "mesh/marks.h"

namespace meshgrain {

FeatureLines noisy_lines(const Mesh& triangles, double arm) {
  std::vector<EdgeOfLine> edges;
  // As ragged as the border of a scan.
  for (const auto& ends : sorted_marks(triangles)) edges.push_back({ends, LineKind::border});
  return chain_edges(triangles, edges, {}, arm);
}

}  // namespace meshgrain
