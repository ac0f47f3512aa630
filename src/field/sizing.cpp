#include "meshgrain/sizing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "field/bending.h"
#include "graph/spread.h"
#include "mesh/border.h"
#include "meshgrain/error.h"

namespace meshgrain {
namespace {

/// How strongly a line turns at each of its vertices but the ends: by what angle, from the way that
/// comes there to the way that goes on, both about `arm` long, over that length.
template <typename Use>
void for_each_turn(const FeatureLines& lines, double arm, const Use& use) {
  for (std::size_t line = 0; line < lines.size(); ++line) {
    const auto begin = static_cast<std::ptrdiff_t>(lines.begin(line));
    const auto end = static_cast<std::ptrdiff_t>(lines.end(line));
    const auto point = [&](std::ptrdiff_t k) {
      return lines.positions[static_cast<std::size_t>(k)];
    };
    for (std::ptrdiff_t k = begin + 1; k + 1 < end; ++k) {
      const auto way = [&](std::ptrdiff_t step) {
        std::ptrdiff_t j = k + step;
        while (j > begin && j + 1 < end && (point(j) - point(k)).norm() < arm) j += step;
        return Vec3(point(j) - point(k));
      };
      const Vec3 back = way(-1), on = way(1);
      const double length = (static_cast<double>(back.norm()) + on.norm()) / 2;
      const double angle = std::atan2(back.cross(on).norm(), -back.dot(on));
      if (length > 0) use(lines.vertices[static_cast<std::size_t>(k)], angle / length);
    }
  }
}

/// A chord of length h leaves a surface of curvature k by about k h² / 8. The mean square of that
/// over the surface is least, for a given number of faces (the integral of 1 / h²), if h is
/// proportional to the cube root of 1 / k. Besides, what is round must have room for some faces
/// around it, else its ends are lost.
std::vector<float> lengths_by_bending(const Hierarchy& hierarchy, const Mesh& surface,
                                      const FeatureLines& creases, const Sizing& sizing,
                                      double face_side, const Context& context) {
  const Graph& graph = hierarchy.levels[0];
  const double patch = 0.5 * face_side;  // finer bends than this are noise to such faces
  auto bends = bending(hierarchy, surface, creases, patch * patch, context);
  for_each_turn(creases, patch, [&](Index node, double bend) {
    bends[node] = std::max(bends[node], static_cast<float>(bend));
  });
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < bends.size(); ++i) {
    sum += static_cast<double>(graph.areas[i]) * bends[i];
    area += graph.areas[i];
  }
  std::vector<float> lengths(bends.size(), 1.0f);
  if (!(sum > 0)) return lengths;
  const double exponent = sizing.adaptive / 3;
  const double around = 1.5 / sizing.adaptive;  // the longest face side times the bending
  const double shortest = std::pow(sizing.ratio, -sizing.adaptive);
  const double spread = std::pow(sizing.ratio, sizing.adaptive / 2);
  std::vector<float> most(bends.size());
  for (std::size_t i = 0; i < bends.size(); ++i) {
    const double longest = around / std::max(bends[i] * face_side, 1e-9);
    most[i] = static_cast<float>(std::max(longest, shortest));
  }
  // What lies between creases may be narrow, however flat.
  for (const Index i : creases.vertices) most[i] = std::min(most[i], 1.0f);
  // So that the count is that of sides of length 1, as the second bound is not relative.
  constexpr int rounds = 6;
  double scale = 1;
  for (int round = 0; round < rounds; ++round) {
    double cells = 0;
    for (std::size_t i = 0; i < bends.size(); ++i) {
      const double bend = std::max(bends[i] * area / sum, 1e-9);
      const double wanted = scale * std::clamp(std::pow(bend, -exponent), 1 / spread, spread);
      lengths[i] = std::min(static_cast<float>(wanted), most[i]);
      cells += graph.areas[i] / (static_cast<double>(lengths[i]) * lengths[i]);
    }
    scale *= std::sqrt(cells / area);
  }
  return lengths;
}

/// Circles of holes and shafts need some edges to be circles, however large the other faces are.
/// Returns whether any of them has made a length shorter.
bool shorten_around_lines(std::vector<float>& lengths, const Mesh& surface,
                          const FeatureLines& lines, double face_side, const Context& context) {
  if (lines.empty()) return false;
  constexpr double shortest = 0.25;
  bool any = false;
  const auto shorten = [&](Index node, double longest) {
    const auto length = static_cast<float>(std::max(longest / face_side, shortest));
    if (length >= lengths[node]) return;
    lengths[node] = length;
    any = true;
  };
  const auto on_border = mark_ends(border_edges(surface, context), surface.positions.size());
  // An edge as long as half the radius leaves a circle by what Chords tolerate. Borders are less
  // exact and often ragged: what turns within a face's side is no circle.
  for_each_turn(lines, face_side / 2, [&](Index node, double bend) {
    if (!on_border[node]) shorten(node, 0.5 / bend);
  });
  for_each_turn(lines, face_side, [&](Index node, double bend) {
    if (on_border[node]) shorten(node, 1.2 / bend);
  });
  return any;
}

void multiply_by_values(std::vector<float>& lengths, const std::vector<float>& values,
                        const Sizing& sizing) {
  if (values.size() != lengths.size()) throw Error("sizes by value need one value a vertex");
  const bool painted = sizing.kind == Sizing::Kind::paint;
  const double exponent = sizing.kind == Sizing::Kind::density ? -0.5 : 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (painted ? !(std::abs(values[i]) <= 1) : !(values[i] > 0 && std::isfinite(values[i]))) {
      throw Error(painted ? "paint must lie between -1 and 1"
                          : "sizes by value need positive numbers, and one is " +
                                std::to_string(values[i]));
    }
    lengths[i] *= static_cast<float>(painted ? std::pow(sizing.ratio, -0.5 * values[i])
                                             : std::pow(values[i], exponent));
  }
}

void multiply_by_distance(std::vector<float>& lengths, const Graph& graph, const Sizing& sizing) {
  const Vec3 point = sizing.point.cast<float>();
  float farthest = 0;
  for (const Vec3& p : graph.positions) farthest = std::max(farthest, (p - point).norm());
  if (!(farthest > 0)) return;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const float t = (graph.positions[i] - point).norm() / farthest;
    lengths[i] *= (1 + (sizing.ratio - 1) * t) / sizing.ratio;
  }
}

}  // namespace

void check(const Sizing& sizing) {
  if (!(sizing.ratio >= 1) || !std::isfinite(sizing.ratio)) {
    throw Error("the ratio of edge lengths must be at least 1");
  }
  if (!(sizing.adaptive >= 0 && sizing.adaptive <= 1)) {
    throw Error("the adaptivity of sizes must lie between 0 and 1");
  }
  if (!(sizing.grading > 1)) throw Error("the grading of sizes must be larger than 1");
  if (!sizing.point.allFinite()) throw Error("the point that sizes grow from is not finite");
}

EdgeLength relative_edge_lengths(const Hierarchy& hierarchy, const Mesh& surface,
                                 const FeatureLines& creases, const Sizing& sizing,
                                 double face_side, const Context& context) {
  check(sizing);
  if (sizing.is_uniform() && creases.empty()) return EdgeLength(1.0f);
  const Graph& graph = hierarchy.levels[0];
  std::vector<float> lengths(graph.size(), 1.0f);
  if (sizing.adaptive > 0) {
    lengths = lengths_by_bending(hierarchy, surface, creases, sizing, face_side, context);
  }
  if (sizing.kind == Sizing::Kind::distance) {
    multiply_by_distance(lengths, graph, sizing);
  } else if (sizing.is_by_value()) {
    multiply_by_values(lengths, surface.values, sizing);
  }
  const bool is_shortened = shorten_around_lines(lengths, surface, creases, face_side, context);
  if (sizing.is_uniform() && !is_shortened) return EdgeLength(1.0f);
  return EdgeLength(std::move(lengths));
}

EdgeLength graded(const Graph& graph, const EdgeLength& lengths, double growth,
                  const Context& context) {
  if (lengths.uniform()) return lengths;
  std::vector<float> result = lengths.values;
  const auto limit = [&](Index i, Index j) {
    const double distance = (graph.positions[i] - graph.positions[j]).norm();
    return static_cast<float>(result[i] + growth * distance);
  };
  std::vector<std::pair<float, Index>> sources;  // that can shorten a neighbour
  for (Index i = 0; i < graph.size(); ++i) {
    const auto around = graph.neighbors_of(i);
    if (std::any_of(around.begin(), around.end(), [&](Index j) { return result[j] > limit(i, j); }))
      sources.push_back({result[i], i});
  }
  const auto shorten = [&](Index i, Index j) {
    const float most = limit(i, j);
    if (!(most < result[j])) return false;
    result[j] = most;
    return true;
  };
  spread(graph, result, sources, static_cast<float>(growth), shorten, context);
  return EdgeLength(std::move(result));
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
