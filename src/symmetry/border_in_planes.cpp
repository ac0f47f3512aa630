#include "symmetry/border_in_planes.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mesh/border.h"

namespace meshgrain {

bool has_border_in_planes_only(const Mesh& mesh, std::span<const MirrorPlane> planes,
                               const Context& context) {
  return std::ranges::all_of(border_edges(mesh, context), [&](const auto& edge) {
    return std::ranges::any_of(planes, [&](const MirrorPlane& plane) {
      return mesh.positions[edge[0]][plane.axis] == 0 && mesh.positions[edge[1]][plane.axis] == 0;
    });
  });
}

void put_border_into_planes(Mesh& mesh, std::span<const MirrorPlane> planes,
                            const Context& context) {
  const auto nearest = [&](const Vec3& p) {
    const auto distance = [&](const MirrorPlane& plane) { return std::abs(p[plane.axis]); };
    return std::ranges::min_element(planes, {}, distance)->axis;
  };
  std::vector<std::pair<Index, int>> moves;
  for (const auto& [a, b] : border_edges(mesh, context)) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b];
    const int of_a = nearest(p), of_b = nearest(q);
    moves.push_back({a, of_a});
    if (of_a == of_b) continue;
    const bool is_a = std::abs(p[of_b]) <= std::abs(q[of_a]);
    moves.push_back(is_a ? std::pair(a, of_b) : std::pair(b, of_a));
  }
  for (const auto& [v, axis] : moves) mesh.positions[v][axis] = 0;
}

}  // namespace meshgrain
