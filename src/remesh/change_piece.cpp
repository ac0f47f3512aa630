#include "remesh/change_piece.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <utility>

#include "finish/crossings.h"

namespace meshgrain {
namespace {

Eigen::AlignedBox3f box_of(const Extraction& part) {
  Eigen::AlignedBox3f box;
  for (const Vec3& p : part.mesh.positions) box.extend(p);
  return box;
}

}  // namespace

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
  const Eigen::AlignedBox3f box = box_of(piece.extraction).merged(box_of(changed));
  const auto crossings = [&](const Extraction& extraction) {
    return count_crossings(extraction.mesh, box, context);
  };
  if (crossings(result) > crossings(whole)) return false;
  whole = std::move(result);
  return true;
}

}  // namespace meshgrain
