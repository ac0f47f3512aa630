#include "remesh/try_finer_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "graph/vertex_graph.h"
#include "mesh/box_cells.h"
#include "remesh/target.h"

namespace meshgrain {
namespace {

/// Whether there are so few that the features behind them are few, too: two handles alone may make
/// for hundreds of crossings.
bool are_few(const FaultCounts& faults, std::size_t faces) {
  constexpr std::size_t of_one_feature = 60;
  return faults.all() <= std::max(of_one_feature, faces / Flaws::hopeless);
}

/// How short edges are near the faults, beside others, and how far around them, in sides of a face.
struct Finer {
  float length;
  double reach;
};
constexpr Finer ever_more[] = {{0.5f, 0.75}, {0.25f, 1.5}};

/// The surface that was remeshed, with the edge lengths that are wanted as values.
Mesh with_lengths(const Made& made, const Finer& finer) {
  Mesh surface = made.surface();
  const auto reach = static_cast<float>(finer.reach * made.side);
  std::vector<Eigen::AlignedBox3f> near;
  for (const Index v : made.faults.nodes) {
    const Vec3& p = surface.positions[v];
    near.emplace_back(p.array() - reach, p.array() + reach);
  }
  const BoxCells cells(near, reach / 4);
  surface.values.assign(surface.positions.size(), 1);
  for (std::size_t v = 0; v < surface.values.size(); ++v) {
    if (cells.contains(surface.positions[v])) surface.values[v] = finer.length;
  }
  return surface;
}

/// How much longer edges may become elsewhere where faults are not serious: to get rid of some more
/// crossings is not worth a shape that is lost, and mostly fails.
constexpr double most_stretched = 1.4;

/// How many times as long as they are the longest edges become, for as many faces.
double stretch(const Mesh& surface, const RemeshOptions& options, const Context& context) {
  const VertexFaces around = vertex_faces(surface, context);
  const Graph graph = vertex_graph(surface, around, options.graph, context);
  const double area = std::accumulate(graph.areas.begin(), graph.areas.end(), 0.0);
  const std::size_t by_default = default_vertex_count(surface.positions.size(), false);
  const Target target(options, options.faces, by_default, 1);
  const EdgeLength lengths = target.edge_lengths(graph, EdgeLength(surface.values),
                                                 target.growth(options.sizing.grading), context);
  return std::ranges::max(lengths.values) / target.edge_length(area);
}

}  // namespace

void try_finer_faces(Made& made, const RemeshOptions& options, const Make& make,
                     const Context& context) {
  const Mesh& surface = made.result.fields.surface;
  if (surface.is_point_cloud() || !may_remake(options) || !options.sizing.is_uniform() ||
      options.edge_length > 0 || made.faults.are_hardly_any() ||
      !are_few(made.faults, made.result.mesh.faces.size())) {
    return;
  }
  Remaking remaking(made, options, make, context);
  remaking.keep_creases();
  RemeshOptions sized = remaking.options();
  sized.sizing.kind = Sizing::Kind::values;
  const Made before = made;
  for (const Finer& finer : ever_more) {
    if (made.faults.are_hardly_any()) break;
    Mesh lengths = with_lengths(before, finer);
    if (!made.has_serious_faults() && stretch(lengths, sized, context) > most_stretched) break;
    Made other = remaking.made_of(
        std::move(lengths), sized, before,
        "made faces smaller where they would be inverted or pass through each other");
    other.result.fields.surface.values.clear();
    // Where faces stay inverted, a simpler surface may serve better than a part of the way.
    if (other.faults.inverted == 0) remaking.keep_if_better(std::move(other));
  }
}

}  // namespace meshgrain
