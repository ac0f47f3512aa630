#include "border/border_loops.h"

#include <algorithm>

#include "extract/polygon_map.h"
#include "mesh/border.h"

namespace meshgrain {
namespace {

BorderLoop make_loop(std::vector<Index> vertices, const Mesh& surface,
                     std::span<const std::uint8_t> locked) {
  BorderLoop loop;
  const auto first = std::ranges::find_if(vertices, [&](Index v) { return locked[v] != 0; });
  std::rotate(vertices.begin(), first, vertices.end());
  loop.vertices = std::move(vertices);
  const std::size_t count = loop.vertices.size();
  // Between two locked vertices by the length of the way.
  std::vector<double> ways(count + 1, 0);
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3& p = surface.positions[loop.vertices[k]];
    const Vec3& q = surface.positions[loop.vertices[(k + 1) % count]];
    ways[k + 1] = ways[k] + (q - p).norm();
  }
  loop.places.resize(count);
  for (std::size_t k = 0; k < count;) {
    std::size_t next = k + 1;
    while (next < count && !locked[loop.vertices[next]]) ++next;
    const double length = ways[next] - ways[k];
    for (std::size_t i = k; i < next; ++i) {
      const double share = length > 0 ? (ways[i] - ways[k]) / length : 0;
      loop.places[i] = static_cast<double>(loop.locked.size()) + share;
    }
    loop.locked.push_back(loop.vertices[k]);
    k = next;
  }
  return loop;
}

}  // namespace

std::span<const BorderLoops::Place> BorderLoops::places_of(Index vertex) const {
  const auto found = std::ranges::equal_range(places, vertex, {}, &Place::vertex);
  return {found.begin(), found.end()};
}

std::vector<std::uint8_t> rim_vertices(const Mesh& mesh, const Context& context) {
  return mark_ends(rim_edges(mesh, context), mesh.positions.size());
}

BorderLoops find_border_loops(const Mesh& surface, std::span<const std::uint8_t> locked,
                              const Context& context) {
  BorderLoops result;
  std::vector<Index> sources, corners, vertices;
  const PolygonMap map(surface, sources, corners, context);
  std::vector<std::uint8_t> seen(map.halfedges(), 0);
  for (Index start = 0; start < map.halfedges(); ++start) {
    if (corners[start] != no_index || seen[start]) continue;
    vertices.clear();
    Index h = start;
    do {
      seen[h] = 1;
      vertices.push_back(sources[map.origin(h)]);
      h = map.next(h);
    } while (h != start);
    constexpr std::ptrdiff_t least = 3;
    if (std::ranges::count_if(vertices, [&](Index v) { return locked[v] != 0; }) < least) continue;
    result.loops.push_back(make_loop(vertices, surface, locked));
  }
  for (Index l = 0; l < result.loops.size(); ++l) {
    const BorderLoop& loop = result.loops[l];
    for (std::size_t k = 0; k < loop.vertices.size(); ++k) {
      result.places.push_back({loop.vertices[k], l, loop.places[k]});
    }
  }
  std::ranges::stable_sort(result.places, {}, &BorderLoops::Place::vertex);
  return result;
}

}  // namespace meshgrain
