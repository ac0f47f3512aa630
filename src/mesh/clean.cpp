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
#include "mesh/sort_by_vertex.h"
#include "meshgrain/surface.h"
#include "util/collect.h"
#include "util/edge_of.h"
#include "util/sort_unique.h"
#include "util/sum.h"
#include "util/union_find.h"

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

/// What all rotations of a face have in common, in both directions, besides the lowest corner: the
/// two beside it. Of triangles that is all.
template <typename Face>
std::array<Index, 2> key_of(const Face& face) {
  const std::size_t n = face.size(), low = lowest_corner(face);
  const auto [beside, other] =
      std::minmax(face[low + 1 == n ? 0 : low + 1], face[low == 0 ? n - 1 : low - 1]);
  return {beside, other};
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

/// A face under what it shares with its duplicates.
struct Keyed {
  std::array<Index, 2> key;
  Index face;
  auto operator<=>(const Keyed&) const = default;
};

bool all_differ(std::span<const Keyed> faces) {
  for (std::size_t k = 1; k < faces.size(); ++k) {
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      const auto &a = faces[k].key, &b = faces[earlier].key;
      if (a[0] == b[0] && a[1] == b[1]) return false;
    }
  }
  return true;
}

std::vector<EqualFaces> find_duplicates(const Faces& faces, std::size_t vertices,
                                        const Context& context) {
  // Those with the same lowest corner come to lie next to each other, without a sort of them all.
  UninitializedVector<Keyed> keyed(faces.size());
  const std::vector<Index> offsets = with_corners(faces, [&](const auto& corners) {
    const auto put = [&](std::size_t f, Index place) {
      keyed[place] = {key_of(corners(f)), static_cast<Index>(f)};
    };
    return sort_by_lowest_vertex(faces, vertices, put, context);
  });
  const auto duplicates_around = [&](std::size_t first, std::size_t last,
                                     std::vector<EqualFaces>& out) {
    constexpr std::size_t few = 8;
    for (std::size_t v = first; v < last; ++v) {
      const std::span<Keyed> here(&keyed[0] + offsets[v], offsets[v + 1] - offsets[v]);
      if (here.size() <= few && all_differ(here)) continue;
      std::sort(here.begin(), here.end());
      for (std::size_t k = 1; k < here.size(); ++k) {
        for (std::size_t earlier = k; earlier-- > 0 && here[earlier].key == here[k].key;) {
          const Index f = here[k].face, g = here[earlier].face;
          if (faces.degree(f) != faces.degree(g)) continue;
          if (faces.degree(f) > 3 && canonical(faces[f]) != canonical(faces[g])) continue;
          out.push_back({f, g});
          break;
        }
      }
    }
  };
  return collect<EqualFaces>(vertices, duplicates_around, context);
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
  UnionFind pieces(mesh.positions.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = std::as_const(mesh.faces)[f];
    for (const Index v : face) pieces.unite(face[0], v);
  }
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
