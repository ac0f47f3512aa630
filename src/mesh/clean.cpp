#include "meshgrain/clean.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/duplicates.h"
#include "mesh/marks.h"
#include "meshgrain/surface.h"
#include "util/edge_of.h"
#include "util/sort_unique.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

/// Neighbouring corners are known to differ.
bool repeats_a_vertex(std::span<const Index> face, std::vector<Index>& scratch) {
  if (face.size() == 3) return false;
  scratch.assign(face.begin(), face.end());
  std::sort(scratch.begin(), scratch.end());
  return std::adjacent_find(scratch.begin(), scratch.end()) != scratch.end();
}

std::size_t lowest_corner(std::span<const Index> face) {
  return static_cast<std::size_t>(std::ranges::min_element(face) - face.begin());
}

/// What all rotations of a face have in common, in both directions: the lowest corner, the two
/// beside it, and their number. Of triangles that is all.
struct FaceKey {
  Index lowest, beside, other;
  std::uint32_t degree;
  Index face;

  static FaceKey of(std::span<const Index> face, Index number) {
    const std::size_t n = face.size();
    const std::size_t low = lowest_corner(face);
    const auto [beside, other] = std::minmax(face[(low + 1) % n], face[(low + n - 1) % n]);
    return {face[low], beside, other, static_cast<std::uint32_t>(n), number};
  }
  auto whole() const { return std::tuple(beside, other, degree); }
};

/// The corners of a face from the lowest on, towards the lower of its two neighbours.
std::vector<Index> canonical(std::span<const Index> face) {
  const std::size_t n = face.size();
  const std::size_t low = lowest_corner(face);
  const std::size_t step = face[(low + 1) % n] < face[(low + n - 1) % n] ? 1 : n - 1;
  std::vector<Index> result(n);
  for (std::size_t i = 0, at = low; i < n; ++i, at = (at + step) % n) result[i] = face[at];
  return result;
}

/// Marks all faces that have the corners of an earlier one. Returns their number.
std::size_t find_duplicates(const Faces& faces, std::size_t vertices,
                            std::vector<std::uint8_t>& is_duplicate) {
  // Faces with the same lowest corner are next to each other, without a sort of them all.
  std::vector<Index> ends(vertices + 1, 0);
  for (std::size_t f = 0; f < faces.size(); ++f) ++ends[std::ranges::min(faces[f]) + 1];
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<FaceKey> keys(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const FaceKey key = FaceKey::of(faces[f], static_cast<Index>(f));
    keys[ends[key.lowest]++] = key;
  }
  std::size_t count = 0;
  is_duplicate.assign(faces.size(), 0);
  for (auto first = keys.begin(); first != keys.end();) {
    const auto last = keys.begin() + ends[first->lowest];
    if (last - first > 1) {
      std::sort(first, last, [](const FaceKey& a, const FaceKey& b) {
        return std::tuple(a.whole(), a.face) < std::tuple(b.whole(), b.face);
      });
    }
    for (auto k = first; k != last; ++k) {
      for (auto earlier = k; earlier-- != first && earlier->whole() == k->whole();) {
        if (k->degree > 3 && canonical(faces[k->face]) != canonical(faces[earlier->face])) continue;
        is_duplicate[k->face] = 1;
        ++count;
        break;
      }
    }
    first = last;
  }
  return count;
}

/// Keeps the vertices of this increasing list.
void keep_vertices(Mesh& mesh, std::span<const Index> kept) {
  const auto compact = [&](auto& attribute) {
    if (attribute.empty()) return;
    for (std::size_t i = 0; i < kept.size(); ++i) attribute[i] = attribute[kept[i]];
    attribute.resize(kept.size());
  };
  compact(mesh.normals);
  compact(mesh.values);
  compact(mesh.positions);
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

/// Returns their number.
std::size_t drop_unused_vertices(Mesh& mesh) {
  std::vector<Index> number(mesh.positions.size(), no_index);
  for (const Index v : mesh.faces.corners()) number[v] = 0;
  std::vector<Index> kept;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == no_index) continue;
    number[v] = static_cast<Index>(kept.size());
    kept.push_back(static_cast<Index>(v));
  }
  const std::size_t dropped = number.size() - kept.size();
  if (dropped > 0) {
    for (Index& v : mesh.faces.corners()) v = number[v];
    for (auto& edge : mesh.marked_edges) edge = {number[edge[0]], number[edge[1]]};
    std::erase_if(mesh.marked_edges,
                  [](const auto& edge) { return edge[0] == no_index || edge[1] == no_index; });
    keep_vertices(mesh, kept);
  }
  return dropped;
}

}  // namespace

CleanReport clean(Mesh& mesh) {
  CleanReport report;
  if (mesh.is_point_cloud()) {
    report.loose_marks = drop_loose_marks(mesh);
    const std::vector<Index> kept = distinct_positions(mesh.positions);
    report.duplicate_points = mesh.positions.size() - kept.size();
    if (report.duplicate_points > 0) keep_vertices(mesh, kept);
    return report;
  }

  Faces faces;
  faces.reserve(mesh.faces.size(), mesh.faces.corners().size());
  std::vector<Index> face, scratch;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    face.clear();
    for (const Index v : std::as_const(mesh.faces)[f])
      if (face.empty() || face.back() != v) face.push_back(v);
    while (face.size() > 1 && face.front() == face.back()) face.pop_back();
    report.repeated_corners += mesh.faces.degree(f) - face.size();
    if (face.size() < 3 || repeats_a_vertex(face, scratch))
      ++report.degenerate_faces;
    else
      faces.push_back(face);
  }
  std::vector<std::uint8_t> is_duplicate;
  report.duplicate_faces = find_duplicates(faces, mesh.positions.size(), is_duplicate);
  if (report.duplicate_faces > 0) {
    mesh.faces = {};
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (!is_duplicate[f]) mesh.faces.push_back(std::as_const(faces)[f]);
    }
  } else {
    mesh.faces = std::move(faces);
  }
  report.loose_marks = drop_loose_marks(mesh);
  report.unused_vertices = drop_unused_vertices(mesh);
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
  drop_unused_vertices(mesh);
  return static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), 1));
}

}  // namespace meshgrain
