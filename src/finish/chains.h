#pragma once

#include <cstdint>
#include <vector>

#include "finish/chords.h"

namespace meshgrain {

/// Vertices of a mesh that follow each other along a feature line by its edges. A closed chain ends
/// with the vertex that it began with.
struct Chain {
  Index line;
  std::vector<Index> vertices;
  std::vector<Chords::Stop> stops;  // where these are: see find_stops()

  bool is_closed() const { return vertices.front() == vertices.back(); }
};

/// All chains in which some vertex slides.
std::vector<Chain> find_chains(const Chords& chords);

/// Finds where the vertices of a chain are, in the sense of the line: it may be turned around. An
/// end of which that is not known is left out. Returns false if they do not follow each other.
bool find_stops(Chain& chain, const Chords& chords);

}  // namespace meshgrain
