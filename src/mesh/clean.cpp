#include "meshgrain/clean.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh/duplicates.h"
#include "mesh/marks.h"
#include "meshgrain/surface.h"
#include "util/edge_of.h"
#include "util/hash.h"
#include "util/sort_unique.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

bool repeats_a_vertex(std::span<const Index> face, std::vector<Index>& scratch) {
  scratch.assign(face.begin(), face.end());
  std::sort(scratch.begin(), scratch.end());
  return std::adjacent_find(scratch.begin(), scratch.end()) != scratch.end();
}

/// Writes the corners of a face from the lowest on, towards the lower of its two neighbours: the
/// same for all rotations and both directions.
void canonical(std::span<const Index> face, std::vector<Index>& result) {
  const std::size_t n = face.size();
  const std::size_t low =
      static_cast<std::size_t>(std::min_element(face.begin(), face.end()) - face.begin());
  const std::size_t step = face[(low + 1) % n] < face[(low + n - 1) % n] ? 1 : n - 1;
  result.resize(n);
  for (std::size_t i = 0, at = low; i < n; ++i, at = (at + step) % n) result[i] = face[at];
}

/// The faces met so far, in a hash table of their numbers in `faces`.
class FaceSet {
 public:
  explicit FaceSet(std::size_t capacity)
      : mask_(std::bit_ceil(2 * capacity + 1) - 1), table_(mask_ + 1, no_index) {}

  /// Whether `face`, about to be added to the end of `faces`, is none of them.
  bool insert(std::span<const Index> face, const Faces& faces) {
    canonical(face, wanted_);
    std::uint64_t hash = wanted_.size();
    for (const Index v : wanted_) hash = hash64(hash + v + 0x9e3779b97f4a7c15u);
    std::size_t slot = hash & mask_;
    for (; table_[slot] != no_index; slot = (slot + 1) & mask_) {
      canonical(faces[table_[slot]], other_);
      if (wanted_ == other_) return false;
    }
    table_[slot] = static_cast<Index>(faces.size());
    return true;
  }

 private:
  std::size_t mask_;
  std::vector<Index> table_;
  std::vector<Index> wanted_, other_;
};

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
  FaceSet seen(mesh.faces.size());
  std::vector<Index> face, scratch;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    face.clear();
    for (const Index v : mesh.faces[f])
      if (face.empty() || face.back() != v) face.push_back(v);
    while (face.size() > 1 && face.front() == face.back()) face.pop_back();
    report.repeated_corners += mesh.faces.degree(f) - face.size();
    if (face.size() < 3 || repeats_a_vertex(face, scratch))
      ++report.degenerate_faces;
    else if (!seen.insert(face, faces))
      ++report.duplicate_faces;
    else
      faces.push_back(face);
  }

  mesh.faces = std::move(faces);
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
