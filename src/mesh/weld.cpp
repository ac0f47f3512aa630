#include "mesh/weld.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "util/bounding_box.h"

namespace meshgrain {
namespace {

/// Adding zero makes -0 the same as +0, which compare equal. The multipliers are odd constants
/// without structure (splitmix64); the upper half of a product depends on all bits below it.
std::uint64_t hash(const Vec3& p) {
  const std::uint64_t x = std::bit_cast<std::uint32_t>(p.x() + 0.0f);
  const std::uint64_t y = std::bit_cast<std::uint32_t>(p.y() + 0.0f);
  const std::uint64_t z = std::bit_cast<std::uint32_t>(p.z() + 0.0f);
  std::uint64_t h = (x | y << 32) * 0xbf58476d1ce4e5b9u;
  h = ((h ^ h >> 32) + z) * 0x94d049bb133111ebu;
  return h ^ h >> 32;
}

}  // namespace

Index DistinctPositions::add(const Vec3& p) {
  if (2 * positions_.size() >= slots_.size()) grow();
  Index& slot = slots_[find(p)];
  if (slot == no_index) {
    slot = static_cast<Index>(positions_.size());
    positions_.push_back(p);
  }
  return slot;
}

/// The slot that holds `p`, or the empty one where it belongs.
std::size_t DistinctPositions::find(const Vec3& p) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t s = hash(p) & mask;
  while (slots_[s] != no_index && positions_[slots_[s]] != p) s = (s + 1) & mask;
  return s;
}

void DistinctPositions::grow() {
  slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), no_index);
  for (std::size_t v = 0; v < positions_.size(); ++v) {
    slots_[find(positions_[v])] = static_cast<Index>(v);
  }
}

std::size_t weld(Mesh& mesh) {
  const std::size_t before = mesh.positions.size();
  DistinctPositions distinct;
  std::vector<Index> target(before);
  for (std::size_t v = 0; v < before; ++v) target[v] = distinct.add(mesh.positions[v]);
  mesh.positions = distinct.take();
  const std::size_t after = mesh.positions.size();
  if (after == before) return 0;

  // target[v] <= v, and a vertex that is not the first of its position comes after that first one:
  // the arrays can be compacted in place.
  Index next = 0;
  std::vector<Vec3> sums(mesh.normals.empty() ? 0 : after, Vec3::Zero());
  for (std::size_t v = 0; v < before; ++v) {
    const Index t = target[v];
    if (!sums.empty()) sums[t] += mesh.normals[v];
    if (t != next) continue;
    if (!sums.empty()) mesh.normals[t] = mesh.normals[v];
    if (!mesh.values.empty()) mesh.values[t] = mesh.values[v];
    ++next;
  }
  if (!sums.empty()) mesh.normals.resize(after);
  if (!mesh.values.empty()) mesh.values.resize(after);
  for (std::size_t v = 0; v < sums.size(); ++v) {
    const float length = sums[v].norm();
    if (length > 0) mesh.normals[v] = sums[v] / length;  // else opposite ones: the first stays
  }
  for (Index& corner : mesh.faces.corners()) corner = target[corner];
  for (auto& edge : mesh.marked_edges) edge = {target[edge[0]], target[edge[1]]};
  return before - after;
}

void drop_rounding(Mesh& mesh, const Context& context) {
  if (mesh.positions.empty()) return;
  const float least = 1e-9f * bounding_box(mesh.positions, context).diagonal().norm();
  for (Vec3& p : mesh.positions) {
    for (float& x : p) {
      if (std::abs(x) < least) x = 0;
    }
  }
}

bool is_torn(const Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  // Around a vertex of a whole mesh are about six triangles or four quads. If it stands for more
  // than two vertices, these have fewer than three of them each: others need no table.
  if (mesh.faces.empty() || mesh.faces.corners().size() > 3 * count) return false;
  DistinctPositions distinct;
  for (const Vec3& p : mesh.positions) distinct.add(p);
  return 2 * distinct.positions().size() < count;
}

}  // namespace meshgrain
