#include "remesh/flattened_share.h"

#include <algorithm>
#include <cmath>
#include <numbers>
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

/// The finest level whose nodes stand for squares of that side, in the mean: within these noise
/// cancels out.
const Graph& level_of_nodes(const Hierarchy& hierarchy, double side) {
  double area = 0;
  for (const float a : hierarchy.levels[0].areas) area += a;
  std::size_t level = 0;
  const auto is_finer = [&] {
    return area < side * side * static_cast<double>(hierarchy.levels[level].size());
  };
  while (level + 1 < hierarchy.levels.size() && is_finer()) ++level;
  return hierarchy.levels[level];
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

double share_of_thin_tubes(const Hierarchy& hierarchy, double length, const Context& context) {
  const Graph& graph = level_of_nodes(hierarchy, 0.3 * length);
  constexpr double edges_around = 3, whole_turn = 2 * std::numbers::pi;
  const auto least = static_cast<float>(whole_turn / (edges_around * length));
  const auto is_thin = [&](Index i) {
    return std::ranges::any_of(graph.neighbors_of(i), [&](Index j) {
      const float cosine = std::clamp(graph.normals[i].dot(graph.normals[j]), -1.0f, 1.0f);
      return std::acos(cosine) > least * (graph.positions[i] - graph.positions[j]).norm();
    });
  };
  struct Areas {
    double thin = 0, all = 0;
    Areas operator+(const Areas& other) const { return {thin + other.thin, all + other.all}; }
  };
  const Areas areas = sum_over_ranges(
      graph.size(),
      [&](std::size_t begin, std::size_t end) {
        Areas sum;
        for (auto i = static_cast<Index>(begin); i < end; ++i) {
          sum.all += graph.areas[i];
          if (is_thin(i)) sum.thin += graph.areas[i];
        }
        return sum;
      },
      context);
  return areas.all > 0 ? areas.thin / areas.all : 0;
}

}  // namespace meshgrain
