#include "extract/remove_strips.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "extract/drop_unused.h"
#include "extract/line_edges.h"
#include "util/edge_of.h"

namespace meshgrain {
namespace {

using Edge = std::array<Index, 2>;

/// A row of quads, with the edges between them and at its ends.
struct Strip {
  std::vector<Index> faces;
  std::vector<Edge> rungs;  // one more than faces if it is open
  float width = 0;          // mean length of a rung
};

/// The strips of a mesh of quads, and what may go.
class Strips {
 public:
  explicit Strips(const Extraction& extraction)
      : mesh_(extraction.mesh),
        hold_(held_vertices(extraction)),
        valence_(mesh_.positions.size(), 0),
        on_border_(mesh_.positions.size(), 0) {
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      const auto face = mesh_.faces[f];
      for (std::size_t k = 0; k < 4; ++k) {
        const auto [it, is_new] =
            sides_.try_emplace(edge_of(face[k], face[(k + 1) % 4]), Sides{no_index, no_index});
        manifold_ = manifold_ && (is_new || it->second[1] == no_index);
        it->second[is_new ? 0 : 1] = f;
      }
    }
    for (const auto& [edge, sides] : sides_) {
      for (const Index v : edge) {
        ++valence_[v];
        if (sides[1] == no_index) on_border_[v] = 1;
      }
    }
    for (const LineEdge& edge : extraction.line_edges) line_edges_.insert(edge_of(edge.a, edge.b));
    // The border is a line even where no feature says so.
    for (std::size_t v = 0; v < hold_.size(); ++v) {
      if (on_border_[v] && hold_[v] == free_vertex) hold_[v] = on_line;
    }
  }

  bool is_manifold() const { return manifold_; }

  /// The narrowest of the strips of at most so many faces that may go without harm.
  std::optional<Strip> narrowest(std::size_t most) const {
    std::vector<Strip> strips;
    std::set<Edge> seen;
    for (const auto& [edge, sides] : sides_) {
      if (seen.contains(edge)) continue;
      Strip strip = follow(edge);
      seen.insert(strip.rungs.begin(), strip.rungs.end());
      if (strip.faces.size() <= most) strips.push_back(std::move(strip));
    }
    std::stable_sort(strips.begin(), strips.end(),
                     [](const Strip& a, const Strip& b) { return a.width < b.width; });
    const auto found = std::find_if(strips.begin(), strips.end(),
                                    [&](const Strip& strip) { return may_go(strip); });
    return found == strips.end() ? std::nullopt : std::optional(std::move(*found));
  }

  /// Who stays of the two ends of a rung, and who goes.
  Edge stays_and_goes(const Edge& rung) const {
    const bool first = hold_[rung[0]] >= hold_[rung[1]];
    return first ? rung : Edge{rung[1], rung[0]};
  }
  bool is_held(Index v) const { return hold_[v] != free_vertex; }

 private:
  using Sides = std::array<Index, 2>;

  Edge opposite(Index f, const Edge& edge) const {
    const auto face = mesh_.faces[f];
    for (std::size_t k = 0; k < 4; ++k) {
      if (edge_of(face[k], face[(k + 1) % 4]) == edge) {
        return edge_of(face[(k + 2) % 4], face[(k + 3) % 4]);
      }
    }
    return edge;
  }

  Strip follow(const Edge& start) const {
    Strip strip;
    const auto walk = [&](Index f) {
      Edge at = start;
      while (f != no_index) {
        strip.faces.push_back(f);
        at = opposite(f, at);
        if (at == start) return true;  // around
        strip.rungs.push_back(at);
        const Sides& sides = sides_.at(at);
        f = sides[0] == f ? sides[1] : sides[0];
      }
      return false;
    };
    strip.rungs.push_back(start);
    const Sides& sides = sides_.at(start);
    if (!walk(sides[0])) walk(sides[1]);
    for (const auto& [a, b] : strip.rungs) {
      strip.width += (mesh_.positions[a] - mesh_.positions[b]).norm();
    }
    strip.width /= static_cast<float>(strip.rungs.size());
    return strip;
  }

  bool is_regular(Index v, std::size_t valence) const {
    return valence == (on_border_[v] ? 3u : 4u);
  }

  bool may_go(const Strip& strip) const {
    std::vector<Index> vertices;
    for (const Edge& rung : strip.rungs) {
      const auto [a, b] = stays_and_goes(rung);
      vertices.insert(vertices.end(), {a, b});
      // Two lines must not meet, nor a corner go.
      if (hold_[b] == at_corner) return false;
      const bool is_border = sides_.at(rung)[1] == no_index;
      const bool along_line = line_edges_.contains(rung) || is_border;
      if (hold_[a] != free_vertex && hold_[b] != free_vertex && !along_line) return false;
      // The face beyond would lie along two edges of the line, flat at their vertex.
      if (hold_[a] != free_vertex && !along_line && valence_[b] < 4) return false;
      const std::size_t valence = valence_[a] + valence_[b] - (is_border ? 3 : 4);
      const int before = !is_regular(a, valence_[a]) + !is_regular(b, valence_[b]);
      if (!is_regular(a, valence) && before == 0 && hold_[a] != at_corner) return false;
      if (valence < (on_border_[a] ? 2u : 3u)) return false;
      // The last edge that parts an angle of the border which nothing can bend.
      if (on_border_[a] && hold_[a] == at_corner && valence < std::min<std::size_t>(3, valence_[a]))
        return false;
    }
    // Neither across itself nor around a vertex.
    std::sort(vertices.begin(), vertices.end());
    if (std::adjacent_find(vertices.begin(), vertices.end()) != vertices.end()) return false;
    return keeps_faces_apart(strip);
  }

  /// Whether what is left of the faces around stays faces of four corners, no edge gets a third,
  /// and the border stays what it is.
  bool keeps_faces_apart(const Strip& strip) const {
    std::map<Index, Index> becomes;
    for (const Edge& rung : strip.rungs) {
      const auto [a, b] = stays_and_goes(rung);
      becomes[b] = a;
    }
    const auto after = [&](Index v) {
      const auto it = becomes.find(v);
      return it == becomes.end() ? v : it->second;
    };
    std::vector<Index> gone = strip.faces;
    std::sort(gone.begin(), gone.end());
    std::map<Edge, int> uses;
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      if (std::binary_search(gone.begin(), gone.end(), f)) continue;
      std::array<Index, 4> corners;
      for (std::size_t k = 0; k < 4; ++k) corners[k] = after(mesh_.faces[f][k]);
      for (std::size_t k = 0; k < 4; ++k) {
        if (corners[k] == corners[(k + 2) % 4] || corners[k] == corners[(k + 1) % 4]) return false;
        if (++uses[edge_of(corners[k], corners[(k + 1) % 4])] > 2) return false;
      }
    }
    // The border stays the border: a hole of a few edges must not close.
    const bool stays_open = std::ranges::all_of(sides_, [&](const auto& edge_and_sides) {
      const auto& [edge, sides] = edge_and_sides;
      const Index a = after(edge[0]), b = after(edge[1]);
      if (sides[1] != no_index || a == b) return true;
      const auto it = uses.find(edge_of(a, b));
      return it != uses.end() && it->second == 1;
    });
    return stays_open && !uses.empty();
  }

  const Mesh& mesh_;
  bool manifold_ = true;
  std::map<Edge, Sides> sides_;
  std::set<Edge> line_edges_;
  std::vector<std::uint8_t> hold_;
  std::vector<std::size_t> valence_;
  std::vector<std::uint8_t> on_border_;
};

void remove(Extraction& extraction, const Strips& strips, const Strip& strip) {
  Mesh& mesh = extraction.mesh;
  std::vector<Index> becomes(mesh.positions.size());
  std::iota(becomes.begin(), becomes.end(), Index{0});
  for (const Edge& rung : strip.rungs) {
    const auto [a, b] = strips.stays_and_goes(rung);
    if (!strips.is_held(a)) mesh.positions[a] = 0.5f * (mesh.positions[a] + mesh.positions[b]);
    becomes[b] = a;
  }
  std::vector<std::uint8_t> gone(mesh.faces.size(), 0);
  for (const Index f : strip.faces) gone[f] = 1;
  Faces kept;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!gone[f]) kept.push_back(std::as_const(mesh.faces)[f]);
  }
  mesh.faces = std::move(kept);
  for (Index& v : mesh.faces.corners()) v = becomes[v];
  // What ran along both rails is there once.
  std::map<Edge, Index> lines;
  for (const auto& [a, b, line] : extraction.line_edges) {
    if (becomes[a] != becomes[b]) lines[edge_of(becomes[a], becomes[b])] = line;
  }
  extraction.line_edges.clear();
  for (const auto& [edge, line] : lines) {
    extraction.line_edges.push_back({edge[0], edge[1], line});
  }
  drop_unused(extraction);
}

}  // namespace

std::size_t remove_strips(Extraction& extraction, std::size_t least, std::size_t most,
                          const Context& context) {
  std::size_t done = 0;
  while (done < least) {
    context.check();
    const Strips strips(extraction);
    if (!strips.is_manifold()) break;
    const std::optional<Strip> best = strips.narrowest(most - done);
    if (!best) break;
    done += best->faces.size();
    remove(extraction, strips, *best);
  }
  return done;
}

}  // namespace meshgrain
