#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "meshgrain/features.h"

namespace meshgrain {

/// `drawn`: marked where the surface is smooth, as where materials meet.
enum class LineKind : std::uint8_t { border, crease, marked, drawn, guide };

/// Whether a line turns sharply: by more than an angle, 40 degrees if its cosine is not given.
inline bool is_sharp_turn(const Vec3& in, const Vec3& out, float cosine = 0.766f) {
  return in.dot(out) < cosine * in.norm() * out.norm();
}

struct EdgeOfLine {
  std::array<Index, 2> ends;
  LineKind kind;
};

/// Joins edges of a surface to lines, which end at corners: where a border or a guide meets
/// another kind or more than two edges meet, and where a line turns sharply both from edge to edge
/// and over `edge_length`; if that is drawn and ragged, in the mean of it. No edge may be given
/// twice.
FeatureLines chain_edges(const Mesh& mesh, const std::vector<EdgeOfLine>& edges,
                         const FeatureOptions& options, double edge_length);

}  // namespace meshgrain
