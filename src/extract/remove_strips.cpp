#include "extract/remove_strips.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include "extract/drop_unused.h"
#include "extract/quad_strips.h"
#include "features/feature_edges.h"
#include "mesh/vertex_faces.h"
#include "util/edge_of.h"

namespace meshgrain {
namespace {

using Edge = QuadStrips::Edge;

/// Who stays of the two ends of a rung, and who goes.
Edge stays_and_goes(const QuadStrips& strips, const Edge& rung) {
  const bool first = strips.hold(rung[0]) >= strips.hold(rung[1]);
  return first ? rung : Edge{rung[1], rung[0]};
}

/// Which strips may go without harm.
class Removal {
 public:
  Removal(const Mesh& mesh, const QuadStrips& strips, const Context& context)
      : mesh_(mesh), strips_(strips), around_(vertex_faces(mesh, context)) {}

  /// The faces around the vertices of a strip.
  std::vector<Index> faces_around(const QuadStrip& strip) const {
    std::vector<Index> vertices;
    for (const Index corner : strip.rungs) {
      const Edge rung = strips_.ends(corner);
      vertices.insert(vertices.end(), rung.begin(), rung.end());
    }
    return faces_of(around_, vertices);
  }

  bool may_go(const QuadStrip& strip) const {
    std::vector<Index> vertices;
    for (const Index corner : strip.rungs) {
      const Edge rung = strips_.ends(corner);
      const auto [a, b] = stays_and_goes(strips_, rung);
      vertices.insert(vertices.end(), {a, b});
      // Two lines must not meet, nor a corner go; nor anything where pieces meet.
      if (strips_.hold(b) == at_corner) return false;
      if (strips_.is_branch_vertex(a) || strips_.is_branch_vertex(b)) return false;
      const bool is_border = strips_.is_border(corner);
      const bool along_line = strips_.on_line(rung) || is_border;
      const bool a_is_held = strips_.hold(a) != free_vertex;
      if (a_is_held && strips_.hold(b) != free_vertex && !along_line) return false;
      // The face beyond would lie along two edges of the line, flat at their vertex.
      if (a_is_held && !along_line && strips_.valence(b) < 4) return false;
      const std::size_t valence = strips_.valence(a) + strips_.valence(b) - (is_border ? 3 : 4);
      const int before = !is_regular(a, strips_.valence(a)) + !is_regular(b, strips_.valence(b));
      if (!is_regular(a, valence) && before == 0 && strips_.hold(a) != at_corner) return false;
      const bool on_border = strips_.is_border_vertex(a);
      if (valence < (on_border ? 2u : 3u)) return false;
      // The last edge that parts an angle of the border which nothing can bend.
      if (on_border && strips_.hold(a) == at_corner &&
          valence < std::min<std::size_t>(3, strips_.valence(a))) {
        return false;
      }
    }
    // Neither across itself nor around a vertex.
    std::ranges::sort(vertices);
    if (std::ranges::adjacent_find(vertices) != vertices.end()) return false;
    return keeps_faces_apart(strip, vertices);
  }

 private:
  bool is_regular(Index v, std::size_t valence) const {
    return valence == (strips_.is_border_vertex(v) ? 3u : 4u);
  }

  /// Whether what is left of the faces around stays faces of four corners, no edge gets a third,
  /// and the border stays what it is. `vertices`: those of the strip.
  bool keeps_faces_apart(const QuadStrip& strip, const std::vector<Index>& vertices) const {
    std::map<Index, Index> becomes;
    for (const Index corner : strip.rungs) {
      const auto [a, b] = stays_and_goes(strips_, strips_.ends(corner));
      becomes[b] = a;
    }
    const auto after = [&](Index v) {
      const auto it = becomes.find(v);
      return it == becomes.end() ? v : it->second;
    };
    const std::vector<Index> faces = faces_of(around_, vertices);
    std::vector<Index> gone = strip.faces;
    std::ranges::sort(gone);
    std::map<Edge, int> uses;
    std::vector<Index> border;  // corners where its edges start
    bool any_stays = faces.size() < mesh_.faces.size();
    for (const Index f : faces) {
      for (Index c = 4 * f; c < 4 * f + 4; ++c) {
        if (strips_.is_border(c)) border.push_back(c);
      }
      if (std::ranges::binary_search(gone, f)) continue;
      any_stays = true;
      std::array<Index, 4> corners;
      for (std::size_t k = 0; k < 4; ++k) corners[k] = after(mesh_.faces[f][k]);
      for (std::size_t k = 0; k < 4; ++k) {
        if (corners[k] == corners[(k + 2) % 4] || corners[k] == corners[(k + 1) % 4]) return false;
        if (++uses[edge_of(corners[k], corners[(k + 1) % 4])] > 2) return false;
      }
    }
    // The border stays the border: a hole of a few edges must not close.
    const bool stays_open = std::ranges::all_of(border, [&](Index corner) {
      const auto [from, to] = strips_.ends(corner);
      const Index a = after(from), b = after(to);
      if (a == b) return true;
      const auto it = uses.find(edge_of(a, b));
      return it != uses.end() && it->second == 1;
    });
    return stays_open && any_stays;
  }

  const Mesh& mesh_;
  const QuadStrips& strips_;
  VertexFaces around_;
};

void remove(Extraction& extraction, const QuadStrips& strips,
            const std::vector<QuadStrip>& chosen) {
  Mesh& mesh = extraction.mesh;
  std::vector<Index> becomes(mesh.positions.size());
  std::iota(becomes.begin(), becomes.end(), Index{0});
  std::vector<std::uint8_t> gone(mesh.faces.size(), 0);
  for (const QuadStrip& strip : chosen) {
    for (const Index corner : strip.rungs) {
      const auto [a, b] = stays_and_goes(strips, strips.ends(corner));
      if (strips.hold(a) == free_vertex) {
        mesh.positions[a] = 0.5f * (mesh.positions[a] + mesh.positions[b]);
      }
      becomes[b] = a;
    }
    for (const Index f : strip.faces) gone[f] = 1;
  }
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
  for (std::size_t strips_gone = 0; done < least;) {
    context.check();
    const QuadStrips strips(extraction);
    const Removal removal(extraction.mesh, strips, context);
    StripsApart apart(extraction.mesh, strips_at_once(strips_gone));
    std::vector<QuadStrip> chosen;
    for (QuadStrip& strip : strips.up_to(most - done)) {
      if (done >= least || apart.are_enough()) break;
      const bool fits = strip.faces.size() <= most - done && removal.may_go(strip);
      if (!fits || !apart.add(removal.faces_around(strip))) continue;
      done += strip.faces.size();
      chosen.push_back(std::move(strip));
    }
    if (chosen.empty()) break;
    strips_gone += chosen.size();
    remove(extraction, strips, chosen);
  }
  return done;
}

}  // namespace meshgrain
