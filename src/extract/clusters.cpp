#include "extract/clusters.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/sort_by_vertex.h"
#include "util/indices.h"

namespace meshgrain {
Clusters average_clusters(const Graph& graph, const PositionField& position,
                          std::span<const Index> nodes, std::span<const Index> cluster_of,
                          std::span<const std::uint8_t> border, std::span<const std::uint8_t> hold,
                          std::size_t count, const Context& context) {
  // The members of each cluster, in order.
  UninitializedVector<Index> members(nodes.size());
  const std::vector<Index> offsets = sort_by_vertex(
      nodes.size(), count,
      [&](std::size_t m) {
        return std::span<const Index>(&cluster_of[m], cluster_of[m] == no_index ? 0 : 1);
      },
      [&](std::size_t m, Index place) { members[place] = nodes[m]; }, context);
  Clusters result;
  result.positions.resize(count);
  result.normals.resize(count);
  result.on_border.resize(count);
  result.cover.resize(count);
  result.nodes.resize(count);
  const auto average = [&](Index c) {
    const std::span<const Index> here(members.data() + offsets[c], offsets[c + 1] - offsets[c]);
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
    float weight = 0, cover = 0;
    std::uint8_t on_border = 0, most_held = 0;
    for (const Index i : here) {
      const float rho = position.edge_length[i], beta = rho / 3;
      // Never quite zero: a cluster whose members are all far from its lattice point needs a place
      // too.
      const float alpha = std::max(
          std::exp(-(position.points[i] - graph.positions[i]).squaredNorm() / (beta * beta)),
          1e-20f);
      point += alpha * position.points[i];
      normal += alpha * graph.normals[i];
      weight += alpha;
      cover += graph.areas[i] / (rho * rho);
      on_border |= border[i];
      most_held = std::max(most_held, hold[i]);
    }
    point /= weight;
    const float length = normal.norm();
    result.positions[c] = point;
    result.normals[c] = length > 0 ? Vec3(normal / length) : Vec3(Vec3::UnitZ());
    result.on_border[c] = on_border;
    result.cover[c] = cover;
    float nearest = 0;
    Index& node = result.nodes[c] = no_index;
    for (const Index i : here) {
      if (hold[i] < most_held) continue;
      const float distance = (graph.positions[i] - point).squaredNorm();
      if (node != no_index && distance >= nearest) continue;
      nearest = distance;
      node = i;
    }
  };
  for_indices(count, average, context);
  const auto mean_cover = static_cast<float>(
      std::accumulate(result.cover.begin(), result.cover.end(), 0.0) / static_cast<double>(count));
  for (float& cover : result.cover) cover /= mean_cover;
  return result;
}

void Clusters::append_mean(std::span<const Index> some) {
  Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
  for (const Index c : some) {
    position += positions[c];
    normal += normals[c];
  }
  const Index first = some[0];
  positions.push_back(position / static_cast<float>(some.size()));
  const float length = normal.norm();
  normals.push_back(length > 1e-6f ? Vec3(normal / length) : normals[first]);
  nodes.push_back(nodes[first]);
  on_border.push_back(0);
  hold.push_back(free_vertex);
}

void Clusters::keep(std::span<const Index> kept) {
  const auto gather = [&](auto& values) {
    for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
    values.resize(kept.size());
  };
  gather(positions);
  gather(normals);
  gather(cover);
  gather(nodes);
  gather(on_border);
  if (!hold.empty()) gather(hold);
}

}  // namespace meshgrain
