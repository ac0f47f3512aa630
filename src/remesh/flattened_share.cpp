#include "remesh/flattened_share.h"

#include <cmath>
#include <vector>

namespace meshgrain {
namespace {

constexpr float crease = 0.7f;  // cosine

/// The vector areas of patches.
using Patches = std::vector<Vec3>;

double total(const Patches& patches) {
  double sum = 0;
  for (const Vec3& area : patches) sum += area.norm();
  return sum;
}

Patches merged(const Patches& patches, const std::vector<Index>& parents, std::size_t count) {
  Patches result(count, Vec3::Zero());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    Vec3& whole = result[parents[i]];
    const float size = whole.norm(), more = patches[i].norm();
    if (size == 0 || whole.dot(patches[i]) > crease * size * more) {
      whole += patches[i];
    } else {
      whole *= (size + more) / size;
    }
  }
  return result;
}

}  // namespace

double flattened_share(const Hierarchy& hierarchy, double patch) {
  const Graph& finest = hierarchy.levels[0];
  Patches patches(finest.size());
  for (std::size_t i = 0; i < patches.size(); ++i) patches[i] = finest.areas[i] * finest.normals[i];
  const double area = total(patches);
  double left = area;
  for (std::size_t level = 0; level + 1 < hierarchy.levels.size(); ++level) {
    const std::size_t count = hierarchy.levels[level + 1].size();
    const double finer = area / static_cast<double>(patches.size());
    const double coarser = area / static_cast<double>(count);
    if (!(finer < patch)) break;
    patches = merged(patches, hierarchy.parents[level], count);
    const double before = left;
    left = total(patches);
    if (coarser > patch) {  // in between
      const double share = std::log(patch / finer) / std::log(coarser / finer);
      left = before + share * (left - before);
    }
  }
  return area > 0 ? left / area : 1;
}

}  // namespace meshgrain
