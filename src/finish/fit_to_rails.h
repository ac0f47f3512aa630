#pragma once

#include "finish/chords.h"

namespace meshgrain {

/// Slides vertices a little along lines that turn sharply between them, to where the edges cut off
/// less: ragged borders of scans.
void fit_to_rails(Mesh& mesh, const Chords& chords, Rails& rails);

}  // namespace meshgrain
