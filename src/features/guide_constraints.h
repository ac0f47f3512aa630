#pragma once

#include <span>

#include "features/cut_guides.h"
#include "meshgrain/alignment.h"

namespace meshgrain {

/// Constraints that hold both fields to guides that were cut into the surface. Where guides end or
/// meet, positions are those of the feature lines' corners (feature_constraints).
FeatureConstraints guide_constraints(const GuideLines& guides, std::span<const Index> corners);

/// Constraints that draw both fields to guides: at the nodes nearest to these, with their
/// strengths.
FeatureConstraints guide_constraints(const Graph& graph, std::span<const GuideRun> runs);

}  // namespace meshgrain
