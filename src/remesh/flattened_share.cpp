#include "remesh/flattened_share.h"

#include <cmath>
#include <vector>

#include "util/sum.h"

namespace meshgrain {
namespace {

constexpr float crease = 0.7f;  // cosine
constexpr std::size_t grain = 4096;

/// The vector areas of patches.
using Patches = std::vector<Vec3>;

double total(const Patches& patches, const Context& context) {
  return sum_over_ranges(
      patches.size(),
      [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += patches[i].norm();
        return sum;
      },
      context);
}

Patches merged(const Patches& patches, const Children& children, const Context& context) {
  Patches result(children.size());
  context.for_ranges(result.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      Vec3 whole = Vec3::Zero();
      for (const Index i : children[k]) {
        const float size = whole.norm(), more = patches[i].norm();
        if (size == 0 || whole.dot(patches[i]) > crease * size * more) {
          whole += patches[i];
        } else {
          whole *= (size + more) / size;
        }
      }
      result[k] = whole;
    }
  });
  return result;
}

}  // namespace

double flattened_share(const Hierarchy& hierarchy, double patch, const Context& context) {
  const Graph& finest = hierarchy.levels[0];
  Patches patches(finest.size());
  context.for_ranges(patches.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) patches[i] = finest.areas[i] * finest.normals[i];
  });
  const double area = total(patches, context);
  double left = area;
  for (std::size_t level = 0; level + 1 < hierarchy.levels.size(); ++level) {
    const std::size_t count = hierarchy.levels[level + 1].size();
    const double finer = area / static_cast<double>(patches.size());
    const double coarser = area / static_cast<double>(count);
    if (!(finer < patch)) break;
    patches = merged(patches, hierarchy.children[level], context);
    const double before = left;
    left = total(patches, context);
    if (coarser > patch) {  // in between
      const double share = std::log(patch / finer) / std::log(coarser / finer);
      left = before + share * (left - before);
    }
  }
  return area > 0 ? left / area : 1;
}

}  // namespace meshgrain
