#include "finish/placement.h"

#include <algorithm>

namespace meshgrain {

Placement::Placement(Extraction& extraction, const Mesh& surface, const VertexFaces& around_surface,
                     const Graph& graph, const FeatureLines& lines, const Context& context)
    : extraction_(extraction),
      projector_(surface, around_surface, graph),
      rails_(extraction, lines, context),
      chords_(extraction.mesh, extraction.line_edges, rails_),
      tether_(extraction.mesh.positions.size(), no_index) {}

Vec3 Placement::place(const Vec3& p, std::size_t v) {
  if (is_fixed(v)) return extraction_.mesh.positions[v];
  if (!rails_.is_free(v)) return rails_.project(p, v);
  const Vec3 q = projector_.project(p, extraction_.nodes[v]);
  if (!is_tethered(v)) return q;
  const auto& [end, radius, node] = tethers_[tether_[v]];
  const float distance = (q - end).norm();
  if (distance <= radius) return q;
  extraction_.nodes[v] = node;  // from afar the walk might not come around a bend
  return projector_.project(end + (radius / distance) * (q - end), extraction_.nodes[v]);
}

void Placement::go_around(const VertexFaces& around) {
  const auto upward = [&](Index v) { return normal(v); };
  meshgrain::go_around(extraction_.mesh, around, upward, chords_, rails_);
}

Vec3 Placement::slide(const Vec3& p, std::size_t v) {
  const Vec3 q = place(p, v);
  if (!rails_.slides(v)) return q;
  const auto stop = chords_.slide(static_cast<Index>(v), q);
  if (!stop) return q;
  rails_.set_place(v, stop->segment);
  return stop->position;
}

void Placement::tether(std::size_t v, const Vec3& p, Index node, const Vec3& end, float radius) {
  extraction_.mesh.positions[v] = p;
  extraction_.nodes[v] = node;
  if (!is_tethered(v)) {
    tether_[v] = static_cast<Index>(tethers_.size());
    tethers_.emplace_back();
  }
  tethers_[tether_[v]] = {end, std::max(radius, (p - end).norm()), node};
}

}  // namespace meshgrain
