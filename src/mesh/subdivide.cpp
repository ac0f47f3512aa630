#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "mesh/long_edges.h"
#include "mesh/midpoint.h"
#include "meshgrain/error.h"
#include "meshgrain/surface.h"
#include "util/edge_of.h"
#include "util/indices.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

/// The edges that are too long, the smaller index first, sorted: the midpoint of each has its place
/// there as its number.
using LongEdges = std::vector<std::array<Index, 2>>;

Index find(const LongEdges& edges, Index a, Index b) {
  const auto it = std::ranges::lower_bound(edges, edge_of(a, b));
  return it != edges.end() && *it == edge_of(a, b) ? static_cast<Index>(it - edges.begin())
                                                   : no_index;
}

/// `limit(a, b)`: the longest that the edge between two vertices may be.
template <typename Limit>
bool is_long(const Mesh& mesh, const Limit& limit, Index a, Index b) {
  const float longest = limit(a, b);
  return (mesh.positions[b] - mesh.positions[a]).squaredNorm() > longest * longest;
}

using Triangle = std::array<Index, 3>;

/// The faces that have an edge that is too long.
template <typename Limit>
std::vector<Index> faces_to_split(const Mesh& mesh, const Limit& limit, const Context& context) {
  const Index* const corners = mesh.faces.corners().data();
  const auto has_long_edge = [&](std::size_t f) {
    const Index a = corners[3 * f], b = corners[3 * f + 1], c = corners[3 * f + 2];
    return is_long(mesh, limit, a, b) | is_long(mesh, limit, b, c) | is_long(mesh, limit, c, a);
  };
  return indices_where(mesh.faces.size(), has_long_edge, context);
}

template <typename Limit>
LongEdges long_edges(const Mesh& mesh, const Limit& limit, std::span<const Triangle> triangles) {
  LongEdges edges;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      if (is_long(mesh, limit, a, b)) edges.push_back(edge_of(a, b));
    }
  }
  sort_unique(edges);
  return edges;
}

/// Splits marked edges at their midpoints, which have the numbers from `first` on.
void split_marks(const LongEdges& edges, Index first, Mesh& mesh) {
  auto& marks = mesh.marked_edges;
  const std::size_t count = marks.size();
  for (std::size_t e = 0; e < count; ++e) {
    const auto [a, b] = marks[e];
    const Index id = find(edges, a, b);
    if (id == no_index) continue;
    marks[e] = {a, first + id};
    marks.push_back({first + id, b});
  }
}

/// Splits one triangle by the midpoints of its long edges (`mid[k]` on the edge from corner k to
/// k + 1).
void split(const std::vector<Vec3>& positions, Triangle v, Triangle mid,
           std::vector<Triangle>& out) {
  const int count = (mid[0] != no_index) + (mid[1] != no_index) + (mid[2] != no_index);
  // Turn the triangle so that the pattern starts at the first edge: the split one if there is one,
  // the whole one last if there are two.
  const auto rotate = [&] {
    v = {v[1], v[2], v[0]};
    mid = {mid[1], mid[2], mid[0]};
  };
  if (count == 0) {
    out.push_back({v[0], v[1], v[2]});
  } else if (count == 1) {
    while (mid[0] == no_index) rotate();
    out.push_back({v[0], mid[0], v[2]});
    out.push_back({mid[0], v[1], v[2]});
  } else if (count == 2) {
    while (mid[2] != no_index) rotate();
    out.push_back({mid[0], v[1], mid[1]});
    // The quadrilateral that is left, along its shorter diagonal.
    if ((positions[mid[0]] - positions[v[2]]).squaredNorm() <
        (positions[mid[1]] - positions[v[0]]).squaredNorm()) {
      out.push_back({v[0], mid[0], v[2]});
      out.push_back({mid[0], mid[1], v[2]});
    } else {
      out.push_back({v[0], mid[0], mid[1]});
      out.push_back({v[0], mid[1], v[2]});
    }
  } else {
    out.push_back({v[0], mid[0], mid[2]});
    out.push_back({mid[0], v[1], mid[1]});
    out.push_back({mid[2], mid[1], v[2]});
    out.push_back({mid[0], mid[1], mid[2]});
  }
}

/// Faces that are being split, in increasing order, with the parts of each up to its end.
struct SplitFaces {
  std::vector<Index> faces;
  std::vector<Triangle> parts;
  std::vector<std::size_t> ends;
};

SplitFaces whole_faces(const Mesh& mesh, std::vector<Index> faces) {
  SplitFaces whole;
  for (const Index f : faces) {
    const auto face = mesh.faces[f];
    whole.parts.push_back({face[0], face[1], face[2]});
    whole.ends.push_back(whole.parts.size());
  }
  whole.faces = std::move(faces);
  return whole;
}

/// Splits all parts at the midpoints of their long edges, which have the numbers from `first` on.
template <typename Limit>
void split_parts(const Mesh& mesh, const Limit& limit, const LongEdges& edges, Index first,
                 SplitFaces& splitting) {
  std::vector<Triangle> parts;
  std::size_t part = 0;
  for (std::size_t& face_end : splitting.ends) {
    for (; part < face_end; ++part) {
      const Triangle& corners = splitting.parts[part];
      Triangle mid;
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = corners[k], b = corners[(k + 1) % 3];
        mid[k] = is_long(mesh, limit, a, b) ? first + find(edges, a, b) : no_index;
      }
      split(mesh.positions, corners, mid, parts);
    }
    face_end = parts.size();
  }
  splitting.parts = std::move(parts);
}

/// Puts the parts in the places of their faces.
void put_in_place(Faces& faces, const SplitFaces& splitting, const Context& context) {
  const auto& [split_faces, parts, ends] = splitting;
  const std::size_t old_count = faces.size(), split_count = split_faces.size();
  Faces result = Faces::uniform(old_count + parts.size() - split_count, 3);
  const Index* const from = std::as_const(faces).corners().data();
  Index* const to = result.corners().data();
  // The parts of each face, and whole faces from there to the next one.
  const auto put = [&](std::size_t k) {
    const std::size_t first = k == 0 ? 0 : ends[k - 1];
    std::size_t place = split_faces[k] - k + first;
    for (std::size_t part = first; part < ends[k]; ++part, ++place) {
      std::ranges::copy(parts[part], to + 3 * place);
    }
    const std::size_t next = k + 1 < split_count ? split_faces[k + 1] : old_count;
    std::copy(from + 3 * (split_faces[k] + std::size_t{1}), from + 3 * next, to + 3 * place);
  };
  std::copy(from, from + 3 * std::size_t{split_faces[0]}, to);
  context.for_ranges(split_count, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) put(k);
  });
  faces = std::move(result);
}

/// Returns whether any edge was split. `on_split` is told of the edge that each new vertex lies on.
template <typename Limit, typename Split>
bool split_long_edges(Mesh& mesh, std::vector<Index> long_faces, const Limit& limit,
                      const Split& on_split, const Context& context) {
  if (long_faces.empty()) return false;
  SplitFaces splitting = whole_faces(mesh, std::move(long_faces));
  // Each round halves what is too long, so 64 rounds pass any finite length in single precision.
  for (int round = 0; round < 64; ++round) {
    context.check();
    const LongEdges edges = long_edges(mesh, limit, splitting.parts);
    if (edges.empty()) break;
    const auto old_count = static_cast<Index>(mesh.positions.size());
    if (edges.size() + old_count > 0xfffffff0u) {
      throw Error(
          "the target edge length is too small: subdividing the input to it takes more than "
          "four thousand million vertices");
    }
    for (const auto& [a, b] : edges) {
      append_midpoint(mesh, a, b);
      on_split(a, b);
    }
    split_parts(mesh, limit, edges, old_count, splitting);
    split_marks(edges, old_count, mesh);
  }
  put_in_place(mesh.faces, splitting, context);
  return true;
}

}  // namespace

std::vector<Index> faces_with_long_edges(const Mesh& mesh, double max_length,
                                         const Context& context) {
  const auto longest = static_cast<float>(max_length);
  return faces_to_split(
      mesh, [&](Index, Index) { return longest; }, context);
}

void subdivide_faces(Mesh& mesh, double max_length, std::vector<Index> long_faces,
                     const Context& context) {
  const auto longest = static_cast<float>(max_length);
  split_long_edges(
      mesh, std::move(long_faces), [&](Index, Index) { return longest; }, [](Index, Index) {},
      context);
}

void subdivide(Mesh& mesh, double max_length, const Context& context) {
  subdivide_faces(mesh, max_length, faces_with_long_edges(mesh, max_length, context), context);
}

bool subdivide(Mesh& mesh, std::vector<float>& max_lengths, const Context& context) {
  const auto limit = [&](Index a, Index b) { return std::min(max_lengths[a], max_lengths[b]); };
  return split_long_edges(
      mesh, faces_to_split(mesh, limit, context), limit,
      [&](Index a, Index b) { max_lengths.push_back(0.5f * (max_lengths[a] + max_lengths[b])); },
      context);
}

}  // namespace meshgrain
