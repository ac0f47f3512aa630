#include "finish/placement.h"

#include <utility>

namespace meshgrain {

Placement::Placement(Extraction& extraction, const Mesh& surface, const Graph& graph,
                     double crease_degrees, const Context& context)
    : extraction_(extraction),
      surface_(surface),
      projector_(surface, graph, context),
      lines_(surface, crease_degrees, context),
      rails_(attach_to_lines(extraction, surface, lines_)) {}

Vec3 Placement::place(const Vec3& p, std::size_t v) {
  Index& on_line = rails_.seed[v];
  if (rails_.fixed[v]) {
    return on_line != no_index ? surface_.positions[on_line] : extraction_.mesh.positions[v];
  }
  return on_line != no_index ? lines_.project(p, on_line)
                             : projector_.project(p, extraction_.nodes[v]);
}

void Placement::pin(std::size_t v, const Vec3& p, Index node) {
  extraction_.mesh.positions[v] = p;
  extraction_.nodes[v] = node;
  rails_.fixed[v] = 1;
}

bool Placement::release(std::size_t v) {
  if (rails_.seed[v] == no_index) return false;
  extraction_.nodes[v] = std::exchange(rails_.seed[v], no_index);
  rails_.fixed[v] = 0;
  return true;
}

}  // namespace meshgrain
