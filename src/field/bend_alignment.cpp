#include "field/bend_alignment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "field/bend_patch.h"
#include "field/rosy.h"
#include "util/collect.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

/// Bends over an edge, in radians, that are pulled at with half of the full strength.
constexpr float half_bend = 0.35f;
/// Weaker pulls are left out.
constexpr float least_strength = 0.01f;

/// Whether the normals about a node differ enough for its patch to be worth looking at. Normals of
/// nodes as large as a face are too coarse to tell more.
bool may_bend(const Graph& graph, Index node) {
  constexpr float least_turn = 0.5f;
  Eigen::AlignedBox3f normals(graph.normals[node]);
  for (const Index j : graph.neighbors_of(node)) normals.extend(graph.normals[j]);
  return normals.diagonal().squaredNorm() > least_turn * least_turn;
}

struct Pull {
  Vec3 direction = Vec3::Zero();
  float strength = 0;
};

/// How much more the patch bends about one axis of the tangent plane than about the other, over an
/// edge; what also bends otherwise counts less.
Pull pull_of(const BendPatch& patch, const Vec3& normal, float edge_length) {
  const Vec3 u = any_tangent(normal), v = normal.cross(u);
  const float uu = patch.product(u, u), uv = patch.product(u, v), vv = patch.product(v, v);
  const float mean = (uu + vv) / 2, half = std::hypot((uu - vv) / 2, uv);
  const float excess = 2 * std::min(std::fabs(mean), half);  // of the larger over the smaller
  if (!(excess > 0)) return {};
  const float bend = edge_length * excess / patch.area * std::min(1.0f, excess / patch.turn);
  const float ratio2 = bend * bend / (half_bend * half_bend);
  constexpr float quarter_turn = std::numbers::pi_v<float> / 2;
  const float angle = std::atan2(uv, (uu - vv) / 2) / 2 + (mean > 0 ? 0 : quarter_turn);
  return {std::cos(angle) * u + std::sin(angle) * v, ratio2 * ratio2 / (1 + ratio2 * ratio2)};
}

/// The patch of each node of a level together with those of its neighbours. Where the surface may
/// not bend they are flat. None at all if it may bend nowhere.
std::vector<BendPatch> ring_patches(const Hierarchy& hierarchy, std::size_t level,
                                    const Mesh& surface, const VertexFaces& around,
                                    const FeatureLines& creases, const Context& context) {
  const Graph& graph = hierarchy.levels[level];
  const std::size_t count = graph.size();
  std::vector<std::uint8_t> bends(count);
  for_indices(
      count, [&](Index i) { bends[i] = may_bend(graph, i); }, context);
  if (std::ranges::find(bends, 1) == bends.end()) return {};

  const BendPatches patches(hierarchy, surface, around, creases, context);
  std::vector<BendPatch> own(count), sums(count);
  constexpr std::size_t grain = 64;  // patches are large, nodes of a coarse level few
  context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    context.check();
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      const bool wanted = bends[i] || std::ranges::any_of(graph.neighbors_of(i),
                                                          [&](Index j) { return bends[j] != 0; });
      if (wanted) {
        own[i] = patches.of(level, i);
      } else {
        own[i].area = graph.areas[i];
      }
    }
  });
  for_indices(
      count, [&](Index i) { sums[i] = with_neighbors(graph, own, i); }, context);
  return sums;
}

/// Evened out on the next finer level: neighbours are pulled alike.
std::vector<BendPatch> evened_out(const Graph& finer, const std::vector<Index>& parents,
                                  const std::vector<BendPatch>& patches, const Context& context) {
  std::vector<BendPatch> sums(finer.size());
  const auto sum_up = [&](Index i) {
    sums[i] = patches[parents[i]];
    if (sums[i].turn == 0) return;
    for (const Index j : finer.neighbors_of(i)) sums[i].add(patches[parents[j]]);
  };
  for_indices(finer.size(), sum_up, context);
  return sums;
}

/// Pulls the vertices that a node stands for.
void pull_vertices(const Hierarchy& hierarchy, std::size_t level, Index node, const Pull& pull,
                   std::vector<OrientationConstraint>& out) {
  if (level > 0) {
    for (const Index child : hierarchy.children[level - 1][node]) {
      pull_vertices(hierarchy, level - 1, child, pull, out);
    }
    return;
  }
  const Vec3 direction = project_to_plane(pull.direction, hierarchy.levels[0].normals[node]);
  const float length = direction.norm();
  if (length > 0.5f) out.push_back({node, direction / length, pull.strength});
}

}  // namespace

std::vector<OrientationConstraint> bend_constraints(const Hierarchy& hierarchy, const Mesh& surface,
                                                    const VertexFaces& around,
                                                    const FeatureLines& creases, float edge_length,
                                                    float strength, const Context& context) {
  if (!(strength > 0) || !are_vertices(hierarchy, surface)) return {};
  // The patches of a level are up to twice as large; larger than a face, they go, with those around
  // them, all around a tube, and do not tell its axis.
  constexpr double share = 0.65;  // of a face
  std::size_t level = level_of_area(hierarchy, share * edge_length * edge_length);
  std::vector<BendPatch> patches =
      ring_patches(hierarchy, level, surface, around, creases, context);
  if (patches.empty()) return {};
  if (level > 0) {
    --level;
    patches = evened_out(hierarchy.levels[level], hierarchy.parents[level], patches, context);
  }
  const auto find = [&](std::size_t begin, std::size_t end,
                        std::vector<OrientationConstraint>& out) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      Pull pull = pull_of(patches[i], hierarchy.levels[level].normals[i], edge_length);
      pull.strength *= std::min(strength, 1.0f);
      if (pull.strength > least_strength) pull_vertices(hierarchy, level, i, pull, out);
    }
  };
  return collect<OrientationConstraint>(patches.size(), find, context);
}

}  // namespace meshgrain
