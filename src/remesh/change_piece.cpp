#include "remesh/change_piece.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include "measure/crossings.h"

namespace meshgrain {

bool is_manifold(const Piece& piece, const ExtractionMap& map) {
  std::vector<std::uint8_t> seen(piece.vertices.size(), 0);
  return std::ranges::none_of(map.sources, [&](Index v) {
    return !piece.on_rim[v] && std::exchange(seen[v], std::uint8_t{1});
  });
}

std::vector<Index> rim_sources(const Piece& piece, const ExtractionMap& map,
                               const std::vector<Index>& vertex, std::size_t count) {
  std::vector<Index> sources(count, no_index);
  for (std::size_t v = 0; v < map.sources.size(); ++v) {
    const Index source = map.sources[v];
    if (vertex[v] != no_index && piece.on_rim[source]) sources[vertex[v]] = source;
  }
  return sources;
}

bool keep_if_apart(Extraction& whole, const Piece& piece, const Extraction& changed,
                   const std::vector<Index>& sources, const Context& context) {
  Extraction result = put_back(whole, piece, changed, sources);
  std::vector<Index> before = piece.faces, after(changed.mesh.faces.size());
  std::ranges::sort(before);
  // put_back() adds them to the faces that stay.
  const std::size_t stay = result.mesh.faces.size() - after.size();
  std::iota(after.begin(), after.end(), static_cast<Index>(stay));
  if (count_crossings_of(result.mesh, after, context) >
      count_crossings_of(whole.mesh, before, context)) {
    return false;
  }
  whole = std::move(result);
  return true;
}

}  // namespace meshgrain
