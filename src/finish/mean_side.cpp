#include "finish/mean_side.h"

#include <cmath>
#include <numbers>

#include "measure/face_shape.h"
#include "util/sum.h"

namespace meshgrain {

float mean_side(const Mesh& mesh, const EdgeLength& relative, const Context& context) {
  struct Areas {
    double faces = 0, wanted = 0;  // wanted: of the regular polygons of side 1 in their places

    Areas operator+(const Areas& o) const { return {faces + o.faces, wanted + o.wanted}; }
  };
  const auto unit_area = [](std::size_t n) {
    const auto count = static_cast<double>(n);
    return n == 4 ? 1 : count / (4 * std::tan(std::numbers::pi / count));
  };
  const Areas areas = sum_over_ranges(
      mesh.faces.size(),
      [&](std::size_t begin, std::size_t end) {
        Areas sum;
        for (std::size_t f = begin; f < end; ++f) {
          const auto face = mesh.faces[f];
          double size = 0;
          for (const Index v : face) size += relative[v] / static_cast<double>(face.size());
          sum.faces += area_vector(face, mesh.positions).norm();
          sum.wanted += size * size * unit_area(face.size());
        }
        return sum;
      },
      context);
  return areas.wanted > 0 ? static_cast<float>(std::sqrt(areas.faces / areas.wanted)) : 0.0f;
}

}  // namespace meshgrain
