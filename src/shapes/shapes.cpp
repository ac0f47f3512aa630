#include "meshgrain/shapes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "meshgrain/error.h"
#include "shapes/makers.h"

namespace meshgrain {
namespace {

struct Shape {
  std::string_view name;
  Mesh (*make)(double resolution);
};

constexpr Shape all_shapes[] = {
    {"bracket", shapes::bracket},
    {"cube", shapes::cube},
    {"twisted-cube", shapes::twisted_cube},
    {"fused-boxes", shapes::fused_boxes},
    {"cylinder", shapes::cylinder},
    {"shaft", shapes::shaft},
    {"sphere", shapes::sphere},
    {"torus", shapes::torus},
    {"three-holes", shapes::three_holes},
    {"blob", shapes::blob},
    {"plate", shapes::plate},
};

}  // namespace

std::vector<std::string> sample_names() {
  std::vector<std::string> names;
  for (const Shape& shape : all_shapes) names.emplace_back(shape.name);
  return names;
}

Mesh sample_shape(std::string_view name, double resolution) {
  if (!(resolution >= 0.1 && resolution <= 500))
    throw Error(
        fmt::format("the resolution of a shape must lie between 0.1 and 500, not {}", resolution));
  for (const Shape& shape : all_shapes)
    if (shape.name == name) return shape.make(resolution);
  throw Error(
      fmt::format("no shape is called '{}'; there are {}", name, fmt::join(sample_names(), ", ")));
}

}  // namespace meshgrain
