#pragma once

#include <array>
#include <span>
#include <vector>

#include "meshgrain/alignment.h"
#include "meshgrain/context.h"
#include "meshgrain/graph.h"

namespace meshgrain {

/// A node at the border of an open cloud.
struct BorderNode {
  Index node = no_index;
  Vec3 point = Vec3::Zero();      ///< Of the straight line that is nearest to the border there.
  Vec3 direction = Vec3::Zero();  ///< Along it; zero at corners.
};

/// In increasing order. The nodes one or two edges away from one leave a third of the directions
/// around it free. Borders of less extent than `smallest` are none.
std::vector<BorderNode> cloud_border(const Graph& graph, float smallest, const Context& context);

/// Those of the graph between them.
std::vector<std::array<Index, 2>> border_edges(const Graph& graph,
                                               std::span<const BorderNode> border);

/// Edges along the border.
FeatureConstraints border_constraints(std::span<const BorderNode> border);

}  // namespace meshgrain
