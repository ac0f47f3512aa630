#include "border/border_loops.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

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

std::vector<std::uint8_t> locked_between(const BorderLoops& borders, const Mesh& surface,
                                         std::span<const std::uint8_t> locked, double side) {
  constexpr double far = 2;  // sides
  std::vector<std::uint8_t> result(locked.begin(), locked.end());
  for (const BorderLoop& loop : borders.loops) {
    const std::size_t count = loop.vertices.size();
    // Of each edge between locked vertices, the length.
    std::vector<double> lengths(loop.locked.size(), 0);
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3& p = surface.positions[loop.vertices[k]];
      const Vec3& q = surface.positions[loop.vertices[(k + 1) % count]];
      lengths[static_cast<std::size_t>(loop.places[k])] += (q - p).norm();
    }
    std::vector<std::size_t> parts(lengths.size(), 1);
    for (std::size_t e = 0; e < lengths.size(); ++e) {
      if (lengths[e] > far * side) parts[e] = static_cast<std::size_t>(lengths[e] / side + 0.5);
    }
    const auto longest = std::ranges::max_element(lengths) - lengths.begin();
    if (parts[longest] == 1) continue;
    parts[longest] += std::accumulate(parts.begin(), parts.end(), std::size_t{0}) % 2;
    // Of all vertices between two locked ones, the nearest to where each part begins.
    struct Nearest {
      double off = 0.5;  // parts
      Index vertex = no_index;
    };
    std::vector<std::size_t> first(parts.size(), 0);
    std::exclusive_scan(parts.begin(), parts.end(), first.begin(), std::size_t{0});
    std::vector<Nearest> nearest(first.back() + parts.back());
    for (std::size_t k = 0; k < count; ++k) {
      const auto edge = static_cast<std::size_t>(loop.places[k]);
      const double at =
          (loop.places[k] - static_cast<double>(edge)) * static_cast<double>(parts[edge]);
      const double part = std::round(at), off = std::abs(at - part);
      if (part >= static_cast<double>(parts[edge])) continue;  // that is the next locked one
      Nearest& best = nearest[first[edge] + static_cast<std::size_t>(part)];
      if (off < best.off) best = {off, loop.vertices[k]};
    }
    for (const Nearest& best : nearest) {
      if (best.vertex != no_index) result[best.vertex] = 1;
    }
  }
  return result;
}

}  // namespace meshgrain
