#include "meshgrain/clean.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/duplicates.h"
#include "mesh/fins.h"
#include "mesh/keep_vertices.h"
#include "mesh/marks.h"
#include "mesh/pieces.h"
#include "mesh/sort_by_vertex.h"
#include "meshgrain/surface.h"
#include "util/collect.h"
#include "util/edge_of.h"
#include "util/hash.h"
#include "util/sort_unique.h"
#include "util/sum.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 1 << 16;

bool repeats_a_vertex(std::span<const Index> face, std::vector<Index>& scratch) {
  if (face.size() == 3) return false;
  scratch.assign(face.begin(), face.end());
  std::sort(scratch.begin(), scratch.end());
  return std::adjacent_find(scratch.begin(), scratch.end()) != scratch.end();
}

std::size_t lowest_corner(std::span<const Index> face) {
  return static_cast<std::size_t>(std::ranges::min_element(face) - face.begin());
}

/// A face under what it shares with its duplicates: the lowest corner and the two beside it, which
/// all rotations of it have in common, in both directions. Of triangles that is all.
struct Keyed {
  Index lowest, beside, other;
  Index face;
  auto operator<=>(const Keyed&) const = default;

  bool has_key_of(const Keyed& o) const {
    return lowest == o.lowest && beside == o.beside && other == o.other;
  }
};

template <typename Face>
Keyed keyed(const Face& face, std::size_t f) {
  if constexpr (Face::extent == 3) {
    const Index a = face[0], b = face[1], c = face[2];
    const Index low = std::min(std::min(a, b), c), high = std::max(std::max(a, b), c);
    return {low, a ^ b ^ c ^ low ^ high, high, static_cast<Index>(f)};
  }
  const std::size_t n = face.size(), low = lowest_corner(face);
  const auto [beside, other] =
      std::minmax(face[low + 1 == n ? 0 : low + 1], face[low == 0 ? n - 1 : low - 1]);
  return {face[low], beside, other, static_cast<Index>(f)};
}

/// The corners of a face from the lowest on, towards the lower of its two neighbours.
std::vector<Index> canonical(std::span<const Index> face) {
  const std::size_t n = face.size();
  const std::size_t low = lowest_corner(face);
  const std::size_t step = face[(low + 1) % n] < face[(low + n - 1) % n] ? 1 : n - 1;
  std::vector<Index> result(n);
  for (std::size_t i = 0, at = low; i < n; ++i, at = (at + step) % n) result[i] = face[at];
  return result;
}

/// Adds the pairs of equal faces among those with the same lowest corner.
void find_equal(const Faces& faces, std::vector<Keyed>& here, std::vector<EqualFaces>& out) {
  std::sort(here.begin(), here.end());
  for (std::size_t k = 1; k < here.size(); ++k) {
    for (std::size_t earlier = k; earlier-- > 0 && here[earlier].has_key_of(here[k]);) {
      const Index f = here[k].face, g = here[earlier].face;
      if (faces.degree(f) != faces.degree(g)) continue;
      if (faces.degree(f) > 3 && canonical(faces[f]) != canonical(faces[g])) continue;
      out.push_back({f, g});
      break;
    }
  }
}

/// Whether there may be equal ones among faces that `at(k)` tells, in the order of their lowest
/// corners, and those after the last that have its lowest corner too. In most meshes this is told
/// at once: without branches, as no one could predict them.
template <typename At>
bool may_be_equal(std::size_t begin, std::size_t end, std::size_t faces, const At& at) {
  constexpr std::size_t few = 8;  // have the same lowest corner, as a rule
  const std::size_t count = std::min(end + few, faces) - begin;
  std::vector<Index> lowest(count), hashes(count);
  for (std::size_t k = 0; k < count; ++k) {
    const Keyed face = at(begin + k);
    lowest[k] = face.lowest;
    const std::uint64_t sides = std::uint64_t{face.beside} << 32 | face.other;
    hashes[k] = static_cast<Index>(hash64(sides)) ^ face.lowest;
  }
  unsigned any = 0;
  for (std::size_t apart = 1; apart < few; ++apart) {
    for (std::size_t k = apart; k < count; ++k) any |= hashes[k] == hashes[k - apart];
  }
  for (std::size_t k = few; k < count; ++k) any |= lowest[k] == lowest[k - few];
  return any != 0;
}

/// The pairs of equal faces among those that `at(k)` tells, in the order of their lowest corners.
template <typename At>
std::vector<EqualFaces> equal_in_order(const Faces& faces, const At& at, const Context& context) {
  const auto starts = [&](std::size_t k) { return k == 0 || at(k - 1).lowest != at(k).lowest; };
  const auto look = [&](std::size_t begin, std::size_t end, std::vector<EqualFaces>& out) {
    if (!may_be_equal(begin, end, faces.size(), at)) return;
    // Those are looked at here whose first one is.
    while (begin < end && !starts(begin)) ++begin;
    for (std::size_t k = begin; k < end;) {
      std::vector<Keyed> here{at(k)};
      while (++k < faces.size() && !starts(k)) here.push_back(at(k));
      find_equal(faces, here, out);
    }
  };
  return collect<EqualFaces>(faces.size(), look, context);
}

template <typename Corners>
bool is_in_order(std::size_t faces, const Corners& corners, const Context& context) {
  const auto steps_down = [&](std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    Index before = begin == 0 ? 0 : std::ranges::min(corners(begin - 1));
    for (std::size_t f = begin; f < end; ++f) {
      const Index lowest = std::ranges::min(corners(f));
      count += lowest < std::exchange(before, lowest);
    }
    return count;
  };
  return sum_over_ranges(faces, steps_down, context) == 0;
}

std::vector<EqualFaces> find_duplicates(const Faces& faces, std::size_t vertices,
                                        const Context& context) {
  return with_corners(faces, [&](const auto& corners) {
    const auto find = [&](std::size_t f) { return keyed(corners(f), f); };
    if (is_in_order(faces.size(), corners, context)) return equal_in_order(faces, find, context);
    // Those with the same lowest corner come to lie next to each other, without a sort of them all.
    UninitializedVector<Keyed> sorted(faces.size());
    const auto put = [&](std::size_t f, Index place) { sorted[place] = find(f); };
    sort_by_lowest_vertex(faces, vertices, put, context);
    return equal_in_order(
        faces, [&](std::size_t k) { return sorted[k]; }, context);
  });
}

/// Whether a face goes twice from one vertex to the same other one: around itself again.
bool repeats_an_edge(std::span<const Index> face) {
  std::vector<std::array<Index, 2>> edges;
  for (std::size_t k = 0; k < face.size(); ++k) {
    edges.push_back({face[k], face[(k + 1) % face.size()]});
  }
  std::sort(edges.begin(), edges.end());
  return std::adjacent_find(edges.begin(), edges.end()) != edges.end();
}

/// Drops corners equal to their neighbour, and spikes: there and back again.
void drop_repeats(std::vector<Index>& face) {
  std::vector<Index> kept;
  for (const Index v : face) {
    if (kept.size() > 1 && kept[kept.size() - 2] == v) kept.pop_back();
    if (kept.empty() || kept.back() != v) kept.push_back(v);
  }
  // What is left lies where the end of the face meets its beginning.
  std::size_t first = 0, end = kept.size();
  while (end - first > 1) {
    if (kept[end - 1] == kept[first] || (end - first > 2 && kept[end - 2] == kept[first])) {
      --end;
    } else if (end - first > 2 && kept[first + 1] == kept[end - 1]) {
      ++first;
    } else {
      break;
    }
  }
  face.assign(kept.begin() + static_cast<std::ptrdiff_t>(first),
              kept.begin() + static_cast<std::ptrdiff_t>(end));
}

/// Drops repeated corners, and faces without three different ones. A face that comes to a vertex
/// twice on different ways stays: so polygons with holes are written.
void drop_repeated_corners(Mesh& mesh, CleanReport& report, const Context& context) {
  const auto is_good = [&](std::span<const Index> corners, std::vector<Index>& scratch) {
    if (corners.size() < 3) return false;
    Index last = corners.back();
    for (const Index v : corners) {
      if (std::exchange(last, v) == v) return false;
    }
    return !repeats_a_vertex(corners, scratch);
  };
  const std::size_t good_faces = with_corners(mesh.faces, [&](const auto& corners) {
    const auto count_good = [&](std::size_t begin, std::size_t end) {
      std::vector<Index> scratch;
      std::size_t count = 0;
      for (std::size_t f = begin; f < end; ++f) count += is_good(corners(f), scratch);
      return count;
    };
    return sum_over_ranges(mesh.faces.size(), count_good, context);
  });
  if (good_faces == mesh.faces.size()) return;
  std::vector<Index> face, scratch;
  Faces faces;
  faces.reserve(mesh.faces.size(), mesh.faces.corners().size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    face.assign(std::as_const(mesh.faces)[f].begin(), std::as_const(mesh.faces)[f].end());
    const bool good = is_good(face, scratch);
    if (!good) drop_repeats(face);
    report.repeated_corners += mesh.faces.degree(f) - face.size();
    if (face.size() < 3 || (!good && repeats_an_edge(face))) {
      ++report.degenerate_faces;
    } else {
      faces.push_back(face);
    }
  }
  mesh.faces = std::move(faces);
}

/// Sorts the marked edges, and drops those that no face has. Returns their number.
std::size_t drop_loose_marks(Mesh& mesh) {
  if (mesh.marked_edges.empty()) return 0;
  const std::vector<std::array<Index, 2>> marks = sorted_marks(mesh);
  std::vector<std::array<Index, 2>> found;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = std::as_const(mesh.faces)[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      const auto edge = edge_of(face[k], face[k + 1 == face.size() ? 0 : k + 1]);
      if (std::binary_search(marks.begin(), marks.end(), edge)) found.push_back(edge);
    }
  }
  sort_unique(found);
  mesh.marked_edges = std::move(found);
  return marks.size() - mesh.marked_edges.size();
}

}  // namespace

CleanReport clean(Mesh& mesh, const Context& context) {
  CleanReport report;
  if (mesh.is_point_cloud()) {
    report.loose_marks = drop_loose_marks(mesh);
    const std::vector<Index> kept = distinct_positions(mesh.positions, nullptr, context);
    report.duplicate_points = mesh.positions.size() - kept.size();
    if (report.duplicate_points > 0) keep_vertices(mesh, kept);
    return report;
  }

  drop_repeated_corners(mesh, report, context);
  const auto duplicates = find_duplicates(mesh.faces, mesh.positions.size(), context);
  if (!duplicates.empty()) {
    std::vector<std::uint8_t> goes(mesh.faces.size(), 0);
    const std::vector<Index> fins = find_fins(mesh, duplicates);
    for (const EqualFaces& pair : duplicates) goes[pair.later] = 1;
    report.fin_faces = fins.size();
    for (const Index f : fins) goes[f] = 1;
    const Faces faces = std::exchange(mesh.faces, {});
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (!goes[f]) mesh.faces.push_back(faces[f]);
    }
    report.duplicate_faces = faces.size() - mesh.faces.size() - fins.size();
  }
  report.loose_marks = drop_loose_marks(mesh);
  report.unused_vertices = drop_unused_vertices(mesh, context);
  return report;
}

std::size_t drop_small_pieces(Mesh& mesh, double least_area) {
  if (mesh.faces.empty()) return 0;
  UnionFind pieces = pieces_of(mesh);
  std::vector<double> area(mesh.positions.size(), 0);
  const auto piece_of = [&](std::size_t f) { return pieces.find(std::as_const(mesh.faces)[f][0]); };
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) area[piece_of(f)] += face_area(mesh, f);
  const double least = std::min(least_area, *std::max_element(area.begin(), area.end()));
  Faces kept;
  kept.reserve(mesh.faces.size(), mesh.faces.corners().size());
  std::vector<std::uint8_t> dropped(area.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Index piece = piece_of(f);
    if (area[piece] < least) {
      dropped[piece] = 1;
    } else {
      kept.push_back(std::as_const(mesh.faces)[f]);
    }
  }
  mesh.faces = std::move(kept);
  drop_unused_vertices(mesh, Context(1));
  return static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), 1));
}

}  // namespace meshgrain
