#include "meshgrain/sizing.h"

#include <algorithm>
#include <cmath>

#include "meshgrain/curvature.h"
#include "meshgrain/error.h"

namespace meshgrain {
namespace {

/// Rounds of averaging with the neighbours, on a logarithmic scale.
void even_out(const Graph& graph, std::vector<float>& lengths, int rounds, const Context& context) {
  for (float& length : lengths) length = std::log(length);
  std::vector<float> next(lengths.size());
  for (int round = 0; round < rounds; ++round) {
    context.for_ranges(graph.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        float sum = lengths[i];
        for (const Index j : graph.neighbors_of(i)) sum += lengths[j];
        next[i] = sum / static_cast<float>(graph.neighbors_of(i).size() + 1);
      }
    });
    lengths.swap(next);
  }
  for (float& length : lengths) length = std::exp(length);
}

}  // namespace

EdgeLength relative_edge_lengths(const Graph& graph, const Sizing& sizing,
                                 const std::vector<float>& values, double edge_length,
                                 const Context& context) {
  if (sizing.kind == Sizing::Kind::uniform) return EdgeLength(1.0f);
  if (!(sizing.ratio >= 1)) throw Error("the ratio of edge lengths must be at least 1");
  const std::size_t n = graph.size();
  std::vector<float> lengths(n, 1.0f);
  if (sizing.kind == Sizing::Kind::values) {
    if (values.size() != n) throw Error("edge lengths by value need one value a vertex");
    for (std::size_t i = 0; i < n; ++i) {
      if (!(values[i] > 0) || !std::isfinite(values[i])) {
        throw Error("edge lengths by value need positive numbers: vertex " + std::to_string(i) +
                    " has " + std::to_string(values[i]));
      }
      lengths[i] = values[i];
    }
  } else if (sizing.kind == Sizing::Kind::distance) {
    const Vec3 point = sizing.point.cast<float>();
    float farthest = 0;
    for (const Vec3& p : graph.positions) farthest = std::max(farthest, (p - point).norm());
    if (farthest > 0) {
      for (std::size_t i = 0; i < n; ++i) {
        const float t = (graph.positions[i] - point).norm() / farthest;
        lengths[i] = (1 + (sizing.ratio - 1) * t) / sizing.ratio;
      }
    }
  } else {
    const Curvature curvature = estimate_curvature(graph.offsets, graph.neighbors, graph.positions,
                                                   graph.normals, context, 2);
    for (std::size_t i = 0; i < n; ++i) {
      // An edge that spans a given angle is as long as the radius is; the clamp keeps flat parts
      // from growing and noise from shrinking without bound.
      const float bend = std::fabs(curvature.kmax[i]) * static_cast<float>(edge_length);
      const float spread = std::sqrt(sizing.ratio);
      lengths[i] = std::clamp(0.35f / std::max(bend, 1e-6f), 1 / spread, spread);
    }
    even_out(graph, lengths, 20, context);
  }
  return EdgeLength(std::move(lengths));
}

double length_for_count(const Graph& graph, const EdgeLength& relative, double face_area,
                        double count) {
  double cells = 0;
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const double length = relative[i];
    cells += graph.areas[i] / (length * length);
  }
  return std::sqrt(cells / (face_area * count));
}

EdgeLength scaled(const EdgeLength& lengths, double factor) {
  EdgeLength result = lengths;
  for (float& value : result.values) value = static_cast<float>(value * factor);
  return result;
}

}  // namespace meshgrain
