#include "mesh/fins.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>

#include "meshgrain/surface.h"
#include "util/edge_of.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

template <typename Body>
void for_each_edge(std::span<const Index> face, const Body& body) {
  for (std::size_t k = 0; k < face.size(); ++k) {
    body(edge_of(face[k], face[k + 1 == face.size() ? 0 : k + 1]));
  }
}

/// Whether faces with the same corners go around in the same direction.
bool is_same_way(std::span<const Index> a, std::span<const Index> b) {
  const auto place = static_cast<std::size_t>(std::ranges::find(b, a[0]) - b.begin());
  return b[place + 1 == b.size() ? 0 : place + 1] == a[1];
}

/// All faces with the same corners, as many of them on either side.
using Leaf = std::vector<Index>;

std::vector<Leaf> find_leaves(const Faces& faces, std::span<const EqualFaces> equal) {
  std::vector<Leaf> leaves;
  for (std::size_t k = 0; k < equal.size();) {
    Leaf leaf{equal[k].earlier};
    int sides = 1;
    for (; k < equal.size() && equal[k].earlier == leaf.back(); ++k) {
      sides += is_same_way(faces[leaf[0]], faces[equal[k].later]) ? 1 : -1;
      leaf.push_back(equal[k].later);
    }
    if (sides == 0) leaves.push_back(std::move(leaf));
  }
  return leaves;
}

}  // namespace

std::vector<Index> find_fins(const Mesh& mesh, std::span<const EqualFaces> equal) {
  const Faces& faces = mesh.faces;
  const std::vector<Leaf> leaves = find_leaves(faces, equal);
  if (leaves.empty()) return {};

  struct Edge {
    std::vector<Index> leaves;
    std::size_t others = 0;  // faces
  };
  std::map<std::array<Index, 2>, Edge> edges;
  std::vector<std::uint8_t> is_other(faces.size(), 1), on_leaf(mesh.positions.size(), 0);
  for (const auto& [later, earlier] : equal) is_other[later] = 0;
  for (Index k = 0; k < leaves.size(); ++k) {
    is_other[leaves[k][0]] = 0;
    for (const Index v : faces[leaves[k][0]]) on_leaf[v] = 1;
    for_each_edge(faces[leaves[k][0]], [&](const auto& ends) { edges[ends].leaves.push_back(k); });
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!is_other[f]) continue;
    for_each_edge(faces[f], [&](const auto& ends) {
      if (!on_leaf[ends[0]] || !on_leaf[ends[1]]) return;
      if (const auto it = edges.find(ends); it != edges.end()) ++it->second.others;
    });
  }

  UnionFind fins(leaves.size());
  for (const auto& [ends, edge] : edges) {
    if (edge.others > 0) continue;
    for (const Index leaf : edge.leaves) fins.unite(edge.leaves[0], leaf);
  }
  std::vector<std::uint8_t> stands(leaves.size(), 0);
  for (const auto& [ends, edge] : edges) {
    if (edge.others < 2) continue;
    for (const Index leaf : edge.leaves) stands[fins.find(leaf)] = 1;
  }
  std::vector<double> area(leaves.size(), 0);
  for (Index k = 0; k < leaves.size(); ++k) area[fins.find(k)] += face_area(mesh, leaves[k][0]);
  constexpr double small = 1e-3;  // of the whole surface
  const double most = small * surface_area(mesh);
  std::vector<Index> result;
  for (Index k = 0; k < leaves.size(); ++k) {
    const Index fin = fins.find(k);
    if (stands[fin] && area[fin] < most) {
      result.insert(result.end(), leaves[k].begin(), leaves[k].end());
    }
  }
  std::ranges::sort(result);
  return result;
}

}  // namespace meshgrain
