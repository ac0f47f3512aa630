#include "extract/add_strips.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <utility>

#include "extract/mean_vertex.h"
#include "extract/quad_strips.h"
#include "util/edge_of.h"

namespace meshgrain {
namespace {

bool crosses_itself(const QuadStrip& strip) {
  std::vector<Index> faces = strip.faces;
  std::ranges::sort(faces);
  return std::ranges::adjacent_find(faces) != faces.end();
}

void cut(Extraction& extraction, const QuadStrips& strips, const QuadStrip& strip) {
  Mesh& mesh = extraction.mesh;
  std::map<QuadStrips::Edge, Index> middles;  // of the rungs
  for (const Index corner : strip.rungs) {
    const QuadStrips::Edge ends = strips.ends(corner);
    const auto [a, b] = ends;
    // Where pieces meet, the place on the input may be on the other one.
    const bool turn = strips.is_branch_vertex(a);
    middles[ends] = append_mean(extraction, QuadStrips::Edge{turn ? b : a, turn ? a : b});
  }
  for (const Index f : strip.faces) {
    std::array<Index, 4> face;
    std::ranges::copy(std::as_const(mesh.faces)[f], face.begin());
    const bool first = middles.contains(edge_of(face[0], face[1]));
    if (!first) std::ranges::rotate(face, face.begin() + 1);  // its rungs: from 0 to 1, from 2 to 3
    const auto [a, b, c, d] = face;
    const Index below = middles.at(edge_of(a, b)), above = middles.at(edge_of(c, d));
    std::ranges::copy(std::array{a, below, above, d}, mesh.faces[f].begin());
    mesh.faces.push_back({below, b, c, above});
  }
  std::vector<LineEdge> lines;
  for (const auto& [a, b, line] : extraction.line_edges) {
    const auto it = middles.find(edge_of(a, b));
    if (it == middles.end()) {
      lines.push_back({a, b, line});
    } else {
      lines.insert(lines.end(), {{a, it->second, line}, {it->second, b, line}});
    }
  }
  extraction.line_edges = std::move(lines);
}

}  // namespace

std::size_t add_strips(Extraction& extraction, std::size_t least, std::size_t most,
                       const Context& context) {
  std::size_t done = 0;
  for (std::size_t strips_more = 0; done < least;) {
    context.check();
    const QuadStrips strips(extraction);
    std::vector<QuadStrip> candidates = strips.up_to(most - done);
    std::erase_if(candidates, crosses_itself);
    std::ranges::stable_sort(candidates, std::ranges::greater(), &QuadStrip::narrowest);
    StripsApart apart(extraction.mesh, strips_at_once(strips_more));
    std::vector<QuadStrip> chosen;
    for (QuadStrip& strip : candidates) {
      if (done >= least || apart.are_enough()) break;
      if (strip.faces.size() > most - done || !apart.add(strip.faces)) continue;
      done += strip.faces.size();
      chosen.push_back(std::move(strip));
    }
    if (chosen.empty()) break;
    strips_more += chosen.size();
    for (const QuadStrip& strip : chosen) cut(extraction, strips, strip);
  }
  return done;
}

}  // namespace meshgrain
