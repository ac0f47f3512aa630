#include "extract/close_cracks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "extract/rename_vertices.h"
#include "mesh/vertex_faces.h"
#include "util/edge_of.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

/// The chains of edges along the lines that are cuts: those with two vertices there.
class Chains {
 public:
  Chains(const Extraction& extraction, const std::vector<std::uint8_t>& on_cut,
         std::span<const Index> same_line)
      : mesh_(extraction.mesh) {
    std::map<Index, std::set<Index>> known;  // vertices on cuts, of each line
    for (const LineEdge& edge : extraction.line_edges) {
      for (const Index v : {edge.a, edge.b}) {
        if (on_cut[v]) known[same_line[edge.line]].insert(v);
      }
    }
    for (const LineEdge& edge : extraction.line_edges) {
      const auto ends = edge_of(edge.a, edge.b);
      const Index line = same_line[edge.line];
      if (ends[0] == ends[1] || known[line].size() < 2) continue;
      lines_.try_emplace(ends, line);
      lines_of_[line].push_back(ends);
    }
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      const auto face = mesh_.faces[f];
      for (std::size_t k = 0; k < face.size(); ++k) {
        const auto ends = edge_of(face[k], face[(k + 1) % face.size()]);
        if (lines_.contains(ends)) ++faces_[ends];
      }
    }
    for (auto& [line, edges] : lines_of_) {
      sort_unique(edges);
      for (const auto& [a, b] : edges) {
        neighbors_[{line, a}].push_back(b);
        neighbors_[{line, b}].push_back(a);
      }
    }
  }

  const std::map<Index, std::vector<std::array<Index, 2>>>& lines() const { return lines_of_; }

  bool has(Index a, Index b) const { return lines_.contains(edge_of(a, b)); }

  /// Whether an edge is on a line, and has one face only.
  bool is_open(Index a, Index b) const {
    const auto it = faces_.find(edge_of(a, b));
    return it != faces_.end() && it->second == 1;
  }

  /// The same of all edges of a way by some vertices.
  bool is_open(Index a, std::span<const Index> between, Index b) const {
    for (const Index v : between) {
      if (!is_open(a, v)) return false;
      a = v;
    }
    return is_open(a, b);
  }

  /// The vertices between the ends of an edge, on the straightest other way along the same line;
  /// none if there is none beside the edge.
  std::vector<Index> way_beside(Index from, Index to) const {
    Way best;
    best.off = most_off * (mesh_.positions[to] - mesh_.positions[from]).norm();
    Way way;
    way.vertices.push_back(from);
    go_on(way, to, lines_.at(edge_of(from, to)), best);
    if (best.vertices.empty()) return {};
    return {best.vertices.begin() + 1, best.vertices.end()};
  }

 private:
  static constexpr float most_off = 0.5f;    // of the edge
  static constexpr std::size_t longest = 6;  // vertices

  struct Way {
    std::vector<Index> vertices;
    float off = 0;  // the largest distance from the edge
  };

  /// Tries all ways on that lead ahead and stay beside the edge, in steps that are shorter: so
  /// faces get ever shorter edges, and closing cracks has an end.
  void go_on(Way& way, Index to, Index line, Way& best) const {
    const Index from = way.vertices.front(), last = way.vertices.back();
    const Vec3& start = mesh_.positions[from];
    const Vec3 along = mesh_.positions[to] - start;
    const float reached = (mesh_.positions[last] - start).dot(along);
    for (const Index next : neighbors_.at({line, last})) {
      const Vec3 step = mesh_.positions[next] - mesh_.positions[last];
      if (step.squaredNorm() >= along.squaredNorm()) continue;
      if (next == to) {
        if (way.off < best.off) best = way;
        continue;
      }
      const Vec3 v = mesh_.positions[next] - start;
      const float share = v.dot(along);
      if (share <= reached || share >= along.squaredNorm()) continue;
      const float off = (v - along * (share / along.squaredNorm())).norm();
      if (off >= best.off || way.vertices.size() == longest) continue;
      Way further = way;
      further.vertices.push_back(next);
      further.off = std::max(way.off, off);
      go_on(further, to, line, best);
    }
  }

  const Mesh& mesh_;
  std::map<std::array<Index, 2>, Index> lines_;
  std::map<Index, std::vector<std::array<Index, 2>>> lines_of_;
  std::map<std::array<Index, 2>, std::vector<Index>> neighbors_;  // of a vertex, along a line
  std::map<std::array<Index, 2>, int> faces_;                     // how many each edge has
};

/// Vertices become those of another chain of their line that are close.
void join_close(Extraction& extraction, const std::vector<std::uint8_t>& on_cut,
                std::span<const Index> same_line, const Context& context) {
  constexpr float close = 0.5f;  // of an edge
  Mesh& mesh = extraction.mesh;
  const Chains chains(extraction, on_cut, same_line);
  const VertexFaces around = vertex_faces(mesh, context);
  std::vector<Index> into(mesh.positions.size(), no_index);
  for (const auto& [line, edges] : chains.lines()) {
    std::map<Index, float> shorter;  // the length of the shorter edge of each vertex
    std::vector<Index> all;
    for (const auto& [a, b] : edges) {
      const float length = (mesh.positions[a] - mesh.positions[b]).norm();
      for (const Index v : {a, b}) {
        all.push_back(v);
        const auto [it, is_new] = shorter.try_emplace(v, length);
        it->second = std::min(it->second, length);
      }
    }
    sort_unique(all);
    for (const auto& [v, length] : shorter) {
      const bool is_corner = std::ranges::find(extraction.corners, v) != extraction.corners.end();
      if (is_corner || into[v] != no_index) continue;
      Index nearest = no_index;
      float least = close * length;
      for (const Index w : all) {
        const float distance = (mesh.positions[v] - mesh.positions[w]).norm();
        if (w == v || into[w] != no_index || distance >= least) continue;
        if (share_any(around[v], around[w])) continue;
        least = distance;
        nearest = w;
      }
      if (nearest == no_index) continue;
      into[v] = nearest;
      into[nearest] = nearest;  // stays, so that faces at it are known
    }
  }
  for (Index v = 0; v < into.size(); ++v) {
    if (into[v] == no_index) into[v] = v;
  }
  rename_vertices(extraction, into);
}

/// A crack beside a face: its edge from corner `k` lacks vertices.
struct Crack {
  std::size_t k = 0;
  std::vector<Index> missing;
};

Crack find_crack(const Chains& chains, std::span<const Index> face, std::size_t most_corners) {
  const auto is_other = [&](Index v) { return std::ranges::find(face, v) == face.end(); };
  for (std::size_t k = 0; k < face.size(); ++k) {
    const Index a = face[k], b = face[(k + 1) % face.size()];
    if (!chains.has(a, b)) continue;
    std::vector<Index> missing = chains.way_beside(a, b);
    if (!chains.is_open(a, b) && !chains.is_open(a, missing, b)) continue;
    const bool fits = most_corners == 3 || face.size() + missing.size() <= most_corners;
    if (!missing.empty() && fits && std::ranges::all_of(missing, is_other)) {
      return {k, std::move(missing)};
    }
  }
  return {};
}

/// A face with the vertices of a crack put in; of a triangle triangles, which have the corner
/// across in common.
void put_in(Faces& faces, std::span<const Index> face, const Crack& crack,
            std::size_t most_corners) {
  std::vector<Index> corners(face.begin(), face.end());
  std::ranges::rotate(corners, corners.begin() + static_cast<std::ptrdiff_t>(crack.k) + 1);
  // Now the edge leads from the last corner to the first.
  corners.insert(corners.end(), crack.missing.begin(), crack.missing.end());
  if (most_corners > 3) {
    faces.push_back(corners);
    return;
  }
  const Index across = corners[1];
  for (std::size_t i = 2; i < corners.size(); ++i) {
    faces.push_back({across, corners[i], corners[(i + 1) % corners.size()]});
  }
}

}  // namespace

void close_cracks(Extraction& extraction, const std::vector<std::uint8_t>& on_cut,
                  std::span<const Index> same_line, std::size_t most_corners,
                  const Context& context) {
  join_close(extraction, on_cut, same_line, context);
  Mesh& mesh = extraction.mesh;
  for (bool again = true; std::exchange(again, false);) {
    context.check();
    const Chains chains(extraction, on_cut, same_line);
    Faces faces;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto face = std::as_const(mesh.faces)[f];
      const Crack crack = find_crack(chains, face, most_corners);
      if (crack.missing.empty()) {
        faces.push_back(face);
      } else {
        put_in(faces, face, crack, most_corners);
        again = true;
      }
    }
    mesh.faces = std::move(faces);
  }
}

}  // namespace meshgrain
