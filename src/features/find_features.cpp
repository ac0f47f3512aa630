#include "features/find_features.h"

#include <algorithm>
#include <array>
#include <utility>

#include "features/leave_out_creases.h"
#include "features/leave_out_fragments.h"
#include "features/mechanical_creases.h"
#include "features/ragged_lines.h"
#include "measure/face_shape.h"
#include "mesh/border.h"
#include "mesh/marks.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

using Edges = std::vector<std::array<Index, 2>>;

/// The marked edges that are between two faces, sorted and each once: those of the border are lines
/// as it is.
std::vector<InnerEdge> inner_marks(const Mesh& mesh, const Context& context) {
  if (mesh.marked_edges.empty()) return {};
  const Edges marks = sorted_marks(mesh);
  const auto is_marked = [&](const InnerEdge& edge) {
    return std::binary_search(marks.begin(), marks.end(), edge.ends);
  };
  return inner_edges(mesh, is_marked, context);
}

bool is_smooth(const Mesh& mesh, const InnerEdge& edge) {
  constexpr double most_degrees = 20;
  const Vec3 left = area_vector(mesh.faces[edge.left], mesh.positions);
  const Vec3 right = area_vector(mesh.faces[edge.right], mesh.positions);
  return left.dot(right) >= sharp_cosine(most_degrees) * left.norm() * right.norm();
}

struct RimAndCreases {
  Edges rim, creases;  // creases: those that are not marked
};

Edges sharper_than(double degrees, const RimAndSharpEdges& found) {
  const double cosine = sharp_cosine(degrees);
  Edges edges;
  for (const SharpEdge& edge : found.sharp) {
    if (edge.cosine < cosine) edges.push_back(edge.ends);
  }
  return edges;
}

Edges creases_by_themselves(const Mesh& mesh, const RimAndSharpEdges& found, double edge_length,
                            const Context& context) {
  switch (kind_of_surface(mesh, found, context)) {
    case SurfaceKind::mechanical_part:
      return mechanical_creases(mesh, found.sharp, context);
    case SurfaceKind::rounded_part:
      return leave_out_fragments(mesh, found.rim, sharper_than(sharp_degrees, found), edge_length);
    case SurfaceKind::sculpture:
      break;
  }
  return {};
}

/// The edges of a sculpture that are as sharp as was asked for are mostly of detail, which nobody
/// meant to be lines.
Edges creases_by_angle(const Mesh& mesh, const RimAndSharpEdges& found, double degrees,
                       double edge_length, const Context& context) {
  Edges creases = sharper_than(degrees, found);
  if (kind_of_surface(mesh, found, context) == SurfaceKind::mechanical_part) return creases;
  return leave_out_fragments(mesh, found.rim, std::move(creases), edge_length);
}

/// Of all that is not the rim.
void leave_out_fragments_of(const Mesh& mesh, const Edges& rim, double edge_length,
                            std::vector<EdgeOfLine>& edges) {
  const auto is_rim = [](const EdgeOfLine& edge) { return edge.kind == LineKind::border; };
  Edges others;
  for (const EdgeOfLine& edge : edges) {
    if (!is_rim(edge)) others.push_back(edge.ends);
  }
  std::ranges::sort(others);
  others = leave_out_fragments(mesh, rim, std::move(others), edge_length);
  std::erase_if(edges, [&](const EdgeOfLine& edge) {
    return !is_rim(edge) && !std::ranges::binary_search(others, edge.ends);
  });
}

RimAndCreases rim_and_creases(const Mesh& mesh, const FeatureOptions& options, double edge_length,
                              const Context& context) {
  if (options.creases == Creases::automatic) {
    auto found = rim_and_sharp_edges(mesh, flat_degrees, context);
    Edges creases = creases_by_themselves(mesh, found, edge_length, context);
    return {std::move(found.rim), std::move(creases)};
  }
  if (options.creases == Creases::by_angle) {
    const double degrees = options.crease_degrees;
    auto found = rim_and_sharp_edges(mesh, std::min(degrees, flat_degrees), context);
    Edges creases = creases_by_angle(mesh, found, degrees, edge_length, context);
    return {std::move(found.rim), std::move(creases)};
  }
  return {rim_edges(mesh, context), {}};
}

FeatureLines even_lines(const Mesh& mesh, const std::vector<EdgeOfLine>& edges,
                        const FeatureOptions& options, double edge_length, const Context& context) {
  FeatureLines lines = chain_edges(mesh, edges, options, edge_length);
  if (edge_length > 0) even_out_ragged_lines(lines, mesh, edges, edge_length, context);
  return lines;
}

}  // namespace

bool FeatureLines::is_closed(std::size_t line) const {
  const Index v = vertices[begin(line)];
  return v == vertices[end(line) - 1] && !std::binary_search(corners.begin(), corners.end(), v);
}

Edges find_creases(const Mesh& mesh, const FeatureOptions& options, double edge_length,
                   const Context& context) {
  const bool any = options.creases == Creases::automatic || options.creases == Creases::by_angle;
  return any ? rim_and_creases(mesh, options, edge_length, context).creases : Edges();
}

std::vector<EdgeOfLine> feature_edges(const Mesh& mesh, const FeatureOptions& options,
                                      double edge_length, const Context& context,
                                      std::span<const std::array<Index, 2>> cuts, double room) {
  auto [rim, creases] = rim_and_creases(mesh, options, edge_length, context);
  if (!cuts.empty()) {
    rim.insert(rim.end(), cuts.begin(), cuts.end());
    sort_unique(rim);
    std::erase_if(creases,
                  [&](const auto& edge) { return std::ranges::binary_search(cuts, edge); });
  }
  std::vector<EdgeOfLine> edges;
  for (const auto& ends : rim) edges.push_back({ends, LineKind::border});
  Edges marked;
  if (options.creases != Creases::none) {
    for (const InnerEdge& mark : inner_marks(mesh, context)) {
      if (std::ranges::binary_search(cuts, mark.ends)) continue;
      marked.push_back(mark.ends);
      edges.push_back({mark.ends, options.marks_may_go    ? LineKind::crease
                                  : is_smooth(mesh, mark) ? LineKind::drawn
                                                          : LineKind::marked});
    }
  }
  for (const auto& ends : creases) {
    const bool is_marked = std::binary_search(marked.begin(), marked.end(), ends);
    if (!is_marked) edges.push_back({ends, LineKind::crease});
  }
  if (room > 0) leave_out_fragments_of(mesh, rim, room, edges);
  return leave_out_creases_beside_lines(mesh, edges, edge_length, context);
}

FeatureLines find_features(const Mesh& mesh, const FeatureOptions& options,
                           const GuideLines& guides, std::span<const std::array<Index, 2>> cuts,
                           double edge_length, double room, const Context& context) {
  std::vector<EdgeOfLine> edges = feature_edges(mesh, options, edge_length, context, cuts, room);
  std::vector<std::array<Index, 2>> others;
  for (const EdgeOfLine& edge : edges) others.push_back(edge.ends);
  std::sort(others.begin(), others.end());
  std::vector<std::uint8_t> on_guide(mesh.positions.size(), 0);
  for (const EdgeOfLine& edge : guides.edges) {
    if (std::binary_search(others.begin(), others.end(), edge.ends)) continue;
    edges.push_back(edge);
    for (const Index v : edge.ends) on_guide[v] = 1;
  }
  FeatureLines lines = even_lines(mesh, edges, options, edge_length, context);
  for (const Index v : lines.corners) on_guide[v] = 0;
  for (std::size_t k = 0; k < lines.vertices.size(); ++k) {
    const Index v = lines.vertices[k];
    if (!on_guide[v]) continue;
    const auto it =
        std::lower_bound(guides.vertices.begin(), guides.vertices.end(), v,
                         [](const GuideLines::Vertex& g, Index w) { return g.vertex < w; });
    lines.positions[k] = it->position;
  }
  return lines;
}

FeatureLines find_features(const Mesh& mesh, const FeatureOptions& options, double edge_length,
                           const Context& context) {
  return even_lines(mesh, feature_edges(mesh, options, edge_length, context), options, edge_length,
                    context);
}

}  // namespace meshgrain
