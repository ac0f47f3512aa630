#include "features/guide_constraints.h"

#include <algorithm>
#include <map>

#include "measure/bvh.h"

namespace meshgrain {
namespace {

void add(FeatureConstraints& result, Index node, const Vec3& point, const Vec3& direction,
         float strength) {
  result.orientation.push_back({node, direction, strength});
  result.position.push_back({node, point, direction, strength});
}

}  // namespace

FeatureConstraints guide_constraints(const GuideLines& guides, std::span<const Index> corners) {
  FeatureConstraints result;
  for (const auto& [v, position, direction] : guides.vertices) {
    if (direction.isZero()) continue;
    if (std::binary_search(corners.begin(), corners.end(), v)) {
      result.orientation.push_back({v, direction, 1});
    } else {
      add(result, v, position, direction, 1);
    }
  }
  return result;
}

FeatureConstraints guide_constraints(const Graph& graph, std::span<const GuideRun> runs) {
  FeatureConstraints result;
  if (runs.empty()) return result;
  Mesh nodes;
  nodes.positions = graph.positions;
  const Bvh tree(nodes);
  struct Nearest {
    double distance;
    const GuideRun::Point* point;
    float strength;
  };
  std::map<Index, Nearest> nearest;
  for (const GuideRun& run : runs) {
    if (run.strength == 0) continue;
    for (const GuideRun::Point& point : run.points) {
      const Bvh::Hit hit = tree.closest(point.position);
      const Nearest found{hit.squared_distance, &point, run.strength};
      const auto [it, is_new] = nearest.try_emplace(hit.triangle, found);
      if (!is_new && found.distance < it->second.distance) it->second = found;
    }
  }
  for (const auto& [node, found] : nearest) {
    add(result, node, found.point->position.cast<float>(), found.point->direction.cast<float>(),
        found.strength);
  }
  return result;
}

}  // namespace meshgrain
