#include "mesh/keep_vertices.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

namespace meshgrain {
namespace {

/// Flags of the vertices that faces have.
std::vector<std::uint8_t> used_vertices(const Mesh& mesh, const Context& context) {
  std::vector<std::uint8_t> is_used(mesh.positions.size(), 0);
  constexpr std::size_t grain = 1 << 16;
  const std::span<const Index> corners = mesh.faces.corners();
  context.for_ranges(corners.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      std::atomic_ref(is_used[corners[c]]).store(1, std::memory_order_relaxed);
    }
  });
  return is_used;
}

}  // namespace

void keep_vertices(Mesh& mesh, std::span<const Index> kept) {
  const auto compact = [&](auto& attribute) {
    if (attribute.empty()) return;
    for (std::size_t i = 0; i < kept.size(); ++i) attribute[i] = attribute[kept[i]];
    attribute.resize(kept.size());
  };
  compact(mesh.normals);
  compact(mesh.values);
  compact(mesh.positions);
}

std::size_t drop_unused_vertices(Mesh& mesh, const Context& context) {
  const std::vector<std::uint8_t> is_used = used_vertices(mesh, context);
  const auto unused = static_cast<std::size_t>(std::ranges::count(is_used, 0));
  if (unused == 0) return 0;
  std::vector<Index> number(is_used.size(), no_index), kept;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (!is_used[v]) continue;
    number[v] = static_cast<Index>(kept.size());
    kept.push_back(static_cast<Index>(v));
  }
  for (Index& v : mesh.faces.corners()) v = number[v];
  for (auto& edge : mesh.marked_edges) edge = {number[edge[0]], number[edge[1]]};
  std::erase_if(mesh.marked_edges,
                [](const auto& edge) { return edge[0] == no_index || edge[1] == no_index; });
  keep_vertices(mesh, kept);
  return unused;
}

}  // namespace meshgrain
