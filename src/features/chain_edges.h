#pragma once

#include <array>
#include <vector>

#include "meshgrain/features.h"

namespace meshgrain {

enum class LineKind : std::uint8_t { border, crease, marked, guide };

struct EdgeOfLine {
  std::array<Index, 2> ends;
  LineKind kind;
};

/// Joins edges of a surface to lines, which end at corners: where a border or a guide meets
/// another kind or more than two edges meet, and where a line turns sharply both from edge to edge
/// and over `edge_length`. No edge may be given twice.
FeatureLines chain_edges(const Mesh& mesh, const std::vector<EdgeOfLine>& edges,
                         const FeatureOptions& options, double edge_length);

}  // namespace meshgrain
