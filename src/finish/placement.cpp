#include "finish/placement.h"

#include <algorithm>
#include <utility>

namespace meshgrain {

Placement::Placement(Extraction& extraction, const Mesh& surface, const Graph& graph,
                     double crease_degrees, const Context& context)
    : extraction_(extraction),
      surface_(surface),
      projector_(surface, graph, context),
      lines_(surface, crease_degrees, context),
      rails_(attach_to_lines(extraction, surface, lines_)),
      tether_(extraction.mesh.positions.size(), no_index) {}

Vec3 Placement::place(const Vec3& p, std::size_t v) {
  Index& on_line = rails_.seed[v];
  if (rails_.fixed[v]) {
    return on_line != no_index ? surface_.positions[on_line] : extraction_.mesh.positions[v];
  }
  if (on_line != no_index) return lines_.project(p, on_line);
  const Vec3 q = projector_.project(p, extraction_.nodes[v]);
  if (!is_tethered(v)) return q;
  const auto& [end, radius] = tethers_[tether_[v]];
  const float distance = (q - end).norm();
  if (distance <= radius) return q;
  return projector_.project(end + (radius / distance) * (q - end), extraction_.nodes[v]);
}

void Placement::tether(std::size_t v, const Vec3& p, Index node, const Vec3& end, float radius) {
  extraction_.mesh.positions[v] = p;
  extraction_.nodes[v] = node;
  if (!is_tethered(v)) {
    tether_[v] = static_cast<Index>(tethers_.size());
    tethers_.emplace_back();
  }
  tethers_[tether_[v]] = {end, std::max(radius, (p - end).norm())};
}

bool Placement::release(std::size_t v) {
  if (rails_.seed[v] == no_index) return false;
  extraction_.nodes[v] = std::exchange(rails_.seed[v], no_index);
  rails_.fixed[v] = 0;
  return true;
}

}  // namespace meshgrain
