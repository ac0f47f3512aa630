#include "finish/feature_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mesh/border.h"
#include "util/sort_unique.h"
#include "util/triangle.h"

namespace meshgrain {
namespace {

/// Points sorted into cubes, to find those within one side of a cube of a place.
class Grid {
 public:
  Grid(std::span<const Vec3> points, std::span<const Index> which, float side)
      : points_(points), side_(std::max(side, 1e-30f)) {
    for (const Index i : which) cells_.emplace_back(cell(points[i]), i);
    std::sort(cells_.begin(), cells_.end());
  }

  /// The nearest point within `radius` (at most the side of a cube), or no_index.
  Index nearest(const Vec3& p, float radius) const {
    Index best = no_index;
    float best_distance = radius * radius;
    const Cell center = cell(p);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const Cell first{center[0] + dx, center[1] + dy, center[2] - 1};
        auto it = std::lower_bound(cells_.begin(), cells_.end(), std::pair(first, Index{0}));
        for (; it != cells_.end() && it->first[0] == first[0] && it->first[1] == first[1] &&
               it->first[2] <= center[2] + 1;
             ++it) {
          const float distance = (points_[it->second] - p).squaredNorm();
          if (distance < best_distance) {
            best_distance = distance;
            best = it->second;
          }
        }
      }
    }
    return best;
  }

 private:
  using Cell = std::array<int, 3>;
  Cell cell(const Vec3& p) const {
    const Vec3 c = p / side_;
    return {static_cast<int>(std::floor(c.x())), static_cast<int>(std::floor(c.y())),
            static_cast<int>(std::floor(c.z()))};
  }

  std::span<const Vec3> points_;
  float side_;
  std::vector<std::pair<Cell, Index>> cells_;
};

/// The creases of a mechanical part; nothing for a sculpture or a scan, whose sharp edges are
/// detail or noise that vertices should not be tied to. Told by the length of edges of every
/// sharpness: in a part they are either nearly flat or creases, with little in between.
std::vector<std::array<Index, 2>> mechanical_creases(const Mesh& surface, double degrees,
                                                     const Context& context) {
  const auto length = [&](const std::vector<std::array<Index, 2>>& edges) {
    double sum = 0;
    for (const auto& [a, b] : edges) sum += (surface.positions[a] - surface.positions[b]).norm();
    return sum;
  };
  auto creases = crease_edges(surface, degrees, context);
  if (creases.empty()) return creases;
  const double sharp = length(creases);
  const double between = length(crease_edges(surface, degrees / 4, context)) - sharp;
  if (sharp <= between) creases.clear();
  return creases;
}

}  // namespace

FeatureLines::FeatureLines(const Mesh& surface, double crease_degrees, const Context& context)
    : surface_(surface) {
  auto edges = rim_edges(surface, context);
  if (crease_degrees >= 0) {
    const auto creases = mechanical_creases(surface, crease_degrees, context);
    edges.insert(edges.end(), creases.begin(), creases.end());
  }
  if (edges.empty()) return;
  const std::size_t n = surface.positions.size();
  offsets_.assign(n + 1, 0);
  for (const auto& [a, b] : edges) {
    ++offsets_[a + 1];
    ++offsets_[b + 1];
  }
  for (std::size_t v = 0; v < n; ++v) offsets_[v + 1] += offsets_[v];
  neighbors_.resize(offsets_[n]);
  std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
  for (const auto& [a, b] : edges) {
    neighbors_[next[a]++] = b;
    neighbors_[next[b]++] = a;
  }
  corner_.assign(n, 0);
  for (Index v = 0; v < n; ++v) {
    if (!contains(v)) continue;
    vertices_.push_back(v);
    const auto around = neighbors(v);
    if (around.size() != 2) {
      corner_[v] = 1;
      continue;
    }
    const Vec3 in = surface.positions[v] - surface.positions[around[0]];
    const Vec3 out = surface.positions[around[1]] - surface.positions[v];
    constexpr float cos40 = 0.766f;
    corner_[v] = in.dot(out) < cos40 * in.norm() * out.norm();
  }
}

Vec3 FeatureLines::project(const Vec3& p, Index& seed) const {
  const auto nearest_at = [&](Index v, Index& end) {
    Vec3 best = surface_.positions[v];
    for (const Index w : neighbors(v)) {
      const Vec3 q =
          closest_point_on_segment<Vec3>(p, surface_.positions[v], surface_.positions[w]);
      if ((q - p).squaredNorm() < (best - p).squaredNorm()) {
        best = q;
        end = w;
      }
    }
    return best;
  };
  Index next = seed;
  Vec3 best = nearest_at(seed, next);
  // Step on while the far end of the nearest segment leads nearer still.
  while (next != seed) {
    Index further = next;
    const Vec3 q = nearest_at(next, further);
    if (!((q - p).squaredNorm() < (best - p).squaredNorm())) break;
    best = q;
    seed = next;
    next = further;
  }
  return best;
}

Rails attach_to_lines(const Extraction& extraction, const Mesh& surface,
                      const FeatureLines& lines) {
  const Mesh& mesh = extraction.mesh;
  const std::size_t n = mesh.positions.size();
  Rails rails{std::vector<Index>(n, no_index), std::vector<std::uint8_t>(n, 0)};
  for (const auto& [a, b] : rim_edges(mesh)) rails.fixed[a] = rails.fixed[b] = 1;
  if (lines.empty()) return rails;

  double length = 0;
  std::vector<std::array<Index, 2>> edges;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index a = face[k], b = face[(k + 1) % face.size()];
      length += (mesh.positions[a] - mesh.positions[b]).norm();
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  const auto mean = static_cast<float>(length / static_cast<double>(edges.size()));
  sort_unique(edges);

  // Clusters on the border have their nearest node there.
  for (Index v = 0; v < n; ++v) {
    if (rails.fixed[v] && lines.contains(extraction.nodes[v])) {
      rails.fixed[v] = 0;
      rails.seed[v] = extraction.nodes[v];
    }
  }
  // On a crease is who lies near one with two of its edges, middles included: what is only noise is
  // not as long as that.
  const float near = 0.25f * mean;
  const Grid grid(surface.positions, lines.vertices(), mean);
  const auto seed_near = [&](const Vec3& p) {
    Index seed = grid.nearest(p, mean);
    return seed != no_index && (lines.project(p, seed) - p).norm() < near ? seed : no_index;
  };
  std::vector<Index> seeds(n);
  for (std::size_t v = 0; v < n; ++v) seeds[v] = seed_near(mesh.positions[v]);
  std::vector<std::uint8_t> chain(n, 0);
  for (const auto& [a, b] : edges) {
    if (seeds[a] == no_index || seeds[b] == no_index) continue;
    if (seed_near(0.5f * (mesh.positions[a] + mesh.positions[b])) == no_index) continue;
    for (const Index v : {a, b}) chain[v] = static_cast<std::uint8_t>(std::min(chain[v] + 1, 2));
  }
  std::vector<Index> attached;
  for (Index v = 0; v < n; ++v) {
    if (rails.seed[v] == no_index && !rails.fixed[v] && chain[v] == 2) rails.seed[v] = seeds[v];
    if (rails.seed[v] != no_index) attached.push_back(v);
  }
  // Corners.
  const Grid candidates(mesh.positions, attached, mean);
  for (const Index corner : lines.vertices()) {
    if (!lines.is_corner(corner)) continue;
    const Index v = candidates.nearest(surface.positions[corner], 0.7f * mean);
    if (v == no_index) continue;
    const auto distance = [&](Index c) {
      return (surface.positions[c] - mesh.positions[v]).squaredNorm();
    };
    if (rails.fixed[v] && distance(rails.seed[v]) <= distance(corner)) continue;
    rails.fixed[v] = 1;
    rails.seed[v] = corner;
  }
  return rails;
}

}  // namespace meshgrain
