#include <cstdint>

#include "meshgrain/shapes.h"
#include "meshgrain/surface.h"
#include "util/hash.h"

namespace meshgrain {

void add_noise(Mesh& mesh, double share) {
  const auto step = static_cast<float>(share * edge_lengths(mesh).mean);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto number = [&](std::uint64_t axis) {  // in [-1, 1)
      return 2 * unit_float(hash64(3 * v + axis)) - 1;
    };
    mesh.positions[v] += step * Vec3(number(0), number(1), number(2)).normalized();
  }
}

}  // namespace meshgrain
