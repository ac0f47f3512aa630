#include "tunnels/sleeve.h"

#include <algorithm>
#include <utility>

#include "tunnels/loop_length.h"
#include "util/sort_unique.h"

namespace meshgrain {

SleeveCutter::SleeveCutter(const Mesh& triangles, const VertexFaces& around)
    : mesh_(triangles),
      around_(around),
      is_out_(triangles.faces.size(), 0),
      is_taken_(triangles.positions.size(), 0) {}

/// Another face than these with that edge, or no_index.
Index SleeveCutter::beyond(const std::vector<Index>& faces, const Halfedge& edge) const {
  for (const Index f : around_[edge[0]]) {
    const bool has_edge = std::ranges::find(mesh_.faces[f], edge[1]) != mesh_.faces[f].end();
    if (has_edge && !is_out_[f] && !std::ranges::binary_search(faces, f)) return f;
  }
  return no_index;
}

/// The halfedges of faces around which there are others, sorted.
std::vector<SleeveCutter::Halfedge> SleeveCutter::rim_of(const std::vector<Index>& faces) const {
  std::vector<Halfedge> halfedges, rim;
  for (const Index f : faces) {
    const auto corners = mesh_.faces[f];
    for (std::size_t k = 0; k < 3; ++k) halfedges.push_back({corners[k], corners[(k + 1) % 3]});
  }
  std::ranges::sort(halfedges);
  for (const auto& [a, b] : halfedges) {
    if (!std::ranges::binary_search(halfedges, Halfedge{b, a})) rim.push_back({a, b});
  }
  return rim;
}

/// Adds faces that have two edges on the rim, and those around vertices where it touches itself.
void SleeveCutter::fill_notches(std::vector<Index>& faces) const {
  constexpr int most_rounds = 8;
  for (int round = 0; round < most_rounds; ++round) {
    sort_unique(faces);
    std::vector<Index> beside, added;
    const std::vector<Halfedge> rim = rim_of(faces);
    for (std::size_t k = 0; k < rim.size(); ++k) {
      if (const Index f = beyond(faces, rim[k]); f != no_index) beside.push_back(f);
      if (k == 0 || rim[k - 1][0] != rim[k][0]) continue;
      for (const Index f : around_[rim[k][0]]) {
        if (!std::ranges::binary_search(faces, f)) added.push_back(f);
      }
    }
    std::ranges::sort(beside);
    for (std::size_t k = 1; k < beside.size(); ++k) {
      if (beside[k] == beside[k - 1]) added.push_back(beside[k]);
    }
    if (added.empty()) return;
    faces.insert(faces.end(), added.begin(), added.end());
  }
}

std::optional<Sleeve> SleeveCutter::sleeve_of(std::vector<Index> faces, double longest_rim) const {
  fill_notches(faces);
  sort_unique(faces);
  const std::vector<Index> vertices = vertices_of(mesh_, faces);
  if (std::ranges::any_of(vertices, [&](Index v) { return is_taken(v); })) return std::nullopt;
  const std::vector<Halfedge> rim = rim_of(faces);
  const std::size_t edges = (3 * faces.size() + rim.size()) / 2;
  if (vertices.size() + faces.size() != edges) return std::nullopt;  // no ring of faces
  Sleeve sleeve{std::move(faces), {}};
  std::vector<std::uint8_t> was_seen(rim.size(), 0);
  for (std::size_t first = 0; first < rim.size(); ++first) {
    if (first > 0 && rim[first][0] == rim[first - 1][0]) return std::nullopt;  // touches itself
    if (was_seen[first]) continue;
    std::vector<Index> loop;
    for (std::size_t k = first; !was_seen[k];) {
      was_seen[k] = 1;
      if (beyond(sleeve.faces, rim[k]) == no_index) return std::nullopt;
      const auto [a, b] = rim[k];
      loop.push_back(a);
      const auto next = std::ranges::lower_bound(rim, Halfedge{b, 0});
      if (next == rim.end() || (*next)[0] != b) return std::nullopt;
      k = static_cast<std::size_t>(next - rim.begin());
    }
    if (loop_length(loop, mesh_.positions) > longest_rim) return std::nullopt;
    sleeve.rims.push_back(std::move(loop));
  }
  if (sleeve.rims.size() != 2) return std::nullopt;
  return sleeve;
}

void SleeveCutter::cut_out(const Sleeve& sleeve) {
  for (const Index f : sleeve.faces) {
    is_out_[f] = 1;
    for (const Index v : mesh_.faces[f]) is_taken_[v] = 1;
  }
}

}  // namespace meshgrain
