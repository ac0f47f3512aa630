#include "border/collar.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshgrain {
namespace {

/// Draws the old border in, so that the strip has some width.
void draw_in(Mesh& mesh, const std::vector<Index>& border) {
  std::vector<std::uint8_t> on_border(mesh.positions.size(), 0);
  for (const Index v : border) on_border[v] = 1;
  std::vector<Vec3> sums(mesh.positions.size(), Vec3::Zero());
  std::vector<float> counts(mesh.positions.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = std::as_const(mesh.faces)[f];
    for (const Index v : face) {
      if (!on_border[v]) continue;
      for (const Index w : face) {
        if (on_border[w]) continue;
        sums[v] += mesh.positions[w];
        ++counts[v];
      }
    }
  }
  for (const Index v : border) {
    if (counts[v] > 0) mesh.positions[v] = 0.5f * (mesh.positions[v] + sums[v] / counts[v]);
  }
}

}  // namespace

void add_collar(Extraction& extraction, const Collar& collar, const Graph& graph, bool quads) {
  Mesh& mesh = extraction.mesh;
  draw_in(mesh, collar.inner);
  std::vector<std::uint8_t> was_border(mesh.positions.size(), 0);
  for (const Index v : collar.inner) was_border[v] = 1;
  std::erase_if(extraction.corners, [&](Index v) { return was_border[v] != 0; });
  std::erase_if(extraction.line_edges,
                [&](const LineEdge& e) { return was_border[e.a] && was_border[e.b]; });
  const auto first = static_cast<Index>(mesh.positions.size());
  for (const Index node : collar.outer_nodes) {
    extraction.corners.push_back(static_cast<Index>(mesh.positions.size()));
    extraction.nodes.push_back(node);
    mesh.positions.push_back(graph.positions[node]);
    mesh.normals.push_back(graph.normals[node]);
  }
  const std::size_t inner = collar.inner.size(), outer = collar.outer_nodes.size();
  // The new vertex that is nearest to the first old one comes first.
  const double begin = collar.inner_places[0];
  const auto away = [&](std::size_t j) {
    return std::abs(std::remainder(collar.outer_places[j] - begin, collar.period));
  };
  std::size_t start = 0;
  for (std::size_t j = 1; j < outer; ++j) {
    if (away(j) < away(start)) start = j;
  }
  const auto inner_vertex = [&](std::size_t i) { return collar.inner[i % inner]; };
  const auto outer_vertex = [&](std::size_t j) {
    return first + static_cast<Index>((start + j) % outer);
  };
  const auto inner_place = [&](std::size_t i) {
    return i < inner ? collar.inner_places[i] - begin : collar.period;
  };
  const auto outer_place = [&](std::size_t j) {
    const double p = collar.outer_places[(start + j) % outer] - collar.outer_places[start];
    return j == outer ? collar.period : p < 0 ? p + collar.period : p;
  };
  const double step = collar.period / static_cast<double>(std::max(inner, outer));
  std::size_t i = 0, j = 0;
  while (i < inner || j < outer) {
    const bool has_both = i < inner && j < outer;
    const double ahead = has_both ? inner_place(i + 1) - outer_place(j + 1) : 0;
    if (quads && has_both && std::abs(ahead) < 0.6 * step) {
      mesh.faces.push_back(
          {inner_vertex(i), inner_vertex(i + 1), outer_vertex(j + 1), outer_vertex(j)});
      ++i;
      ++j;
    } else if (j == outer || (i < inner && ahead < 0)) {
      mesh.faces.push_back({inner_vertex(i), inner_vertex(i + 1), outer_vertex(j)});
      ++i;
    } else {
      mesh.faces.push_back({inner_vertex(i), outer_vertex(j + 1), outer_vertex(j)});
      ++j;
    }
  }
}

}  // namespace meshgrain
