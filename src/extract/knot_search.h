#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "extract/extraction_map.h"
#include "extract/face_repair.h"
#include "meshgrain/context.h"

namespace meshgrain {

/// Closes the quad of a halfedge, or turns its edge (see FaceRepair::may_turn).
struct KnotStep {
  Index h = no_index;
  int from = -1;  // -1: closes
  bool closes() const { return from < 0; }
};

/// Steps that leave a piece of a quad mesh with fewer irregular vertices.
struct Untying {
  std::vector<KnotStep> steps;
  std::size_t irregular = 0;  // vertices, after these
};

/// Does the steps.
void take_steps(FaceRepair& repair, std::span<const KnotStep> steps);

/// Looks for steps that make irregular vertices of a piece cancel each other out: a beam search, as
/// single steps that leave fewer of them were all done before. Its measure is the sum of the
/// squares of `excess`: of each vertex of the piece how many edges it has too many in the whole
/// mesh. Returns the best ends of the search, the fewest irregular vertices first, if they are
/// fewer; no more than `most` quads go.
std::vector<Untying> search_knot(const ExtractionMap& piece, const std::vector<int>& excess,
                                 std::size_t most, const Context& context);

}  // namespace meshgrain
