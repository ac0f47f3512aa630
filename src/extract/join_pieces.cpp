#include "extract/join_pieces.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <utility>

#include "extract/close_cracks.h"
#include "extract/drop_unused.h"
#include "extract/rename_vertices.h"
#include "mesh/vertex_faces.h"
#include "util/edge_of.h"
#include "util/sort_unique.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

class Joining {
 public:
  Joining(Mesh& mesh, const Context& context)
      : mesh_(mesh), around_(vertex_faces(mesh, context)), sets_(mesh.positions.size()) {}

  void join(Index v, Index w, bool along_edge) {
    const Index a = sets_.find(v), b = sets_.find(w);
    if (a == b) return;
    std::vector<Index> both = members(a);
    const std::vector<Index> others = members(b);
    if (share_any(faces_of(around_, both), faces_of(around_, others))) return;
    if (!along_edge && share_any(neighbors(both), neighbors(others))) return;
    both.insert(both.end(), others.begin(), others.end());
    sets_.unite(a, b);
    members_.erase(a);
    members_.erase(b);
    members_[sets_.find(a)] = std::move(both);
  }

  /// The vertex that each has become part of, all of which are at the mean of theirs.
  UnionFind take() && {
    for (const auto& [root, list] : members_) {
      Vec3 sum = Vec3::Zero();
      for (const Index v : list) sum += mesh_.positions[v];
      mesh_.positions[root] = sum / static_cast<float>(list.size());
    }
    return std::move(sets_);
  }

 private:
  std::vector<Index> members(Index root) const {
    const auto it = members_.find(root);
    return it == members_.end() ? std::vector<Index>{root} : it->second;
  }

  /// The vertices that have an edge with one of some, by the sets that they are in.
  std::vector<Index> neighbors(const std::vector<Index>& vertices) {
    std::vector<Index> result;
    for (const Index v : vertices) {
      for (const Index f : around_[v]) {
        const auto face = std::as_const(mesh_.faces)[f];
        const std::size_t n = face.size(), corner = corner_of(face, v);
        for (const std::size_t k : {corner + 1, corner + n - 1}) {
          result.push_back(sets_.find(face[k % n]));
        }
      }
    }
    sort_unique(result);
    return result;
  }

  Mesh& mesh_;
  const VertexFaces around_;
  UnionFind sets_;
  std::map<Index, std::vector<Index>> members_;  // of the sets with more than one
};

}  // namespace

void join_pieces(Extraction& extraction, std::vector<CollapsedMesh::Meeting> meetings,
                 std::span<const Index> vertex, std::span<const Index> same_line,
                 std::size_t most_corners, const Context& context) {
  if (meetings.empty()) return;
  std::ranges::stable_sort(meetings, std::greater(), &CollapsedMesh::Meeting::count);
  Joining joining(extraction.mesh, context);
  for (const auto& [a, b, count, along_edge] : meetings) {
    if (vertex[a] == no_index || vertex[b] == no_index) continue;
    joining.join(vertex[a], vertex[b], along_edge);
  }
  UnionFind sets = std::move(joining).take();
  std::vector<Index> becomes(extraction.mesh.positions.size());
  for (Index v = 0; v < becomes.size(); ++v) becomes[v] = sets.find(v);
  rename_vertices(extraction, becomes);
  std::vector<std::uint8_t> on_cut(extraction.mesh.positions.size(), 0);
  for (const auto& [a, b, count, along_edge] : meetings) {
    if (!along_edge) continue;
    for (const Index cluster : {a, b}) {
      if (vertex[cluster] != no_index) on_cut[sets.find(vertex[cluster])] = 1;
    }
  }
  if (std::ranges::count(on_cut, 1) > 0) {
    close_cracks(extraction, on_cut, same_line, most_corners, context);
  }
  drop_unused(extraction);
}

std::vector<Index> lines_before_cut(const FeatureLines& lines, std::span<const Index> sources) {
  UnionFind sets(lines.size());
  std::map<std::array<Index, 2>, Index> line_of;  // edges as they were
  for (Index line = 0; line < lines.size() && !sources.empty(); ++line) {
    for (Index k = lines.begin(line); k + 1 < lines.end(line); ++k) {
      const auto edge = edge_of(sources[lines.vertices[k]], sources[lines.vertices[k + 1]]);
      sets.unite(line, line_of.try_emplace(edge, line).first->second);
    }
  }
  std::vector<Index> result(lines.size());
  for (Index line = 0; line < lines.size(); ++line) result[line] = sets.find(line);
  return result;
}

std::vector<std::uint8_t> lines_of_cut(std::span<const Index> same_line) {
  std::vector<std::uint8_t> result(same_line.size(), 0);
  bool any = false;
  for (Index line = 0; line < same_line.size(); ++line) {
    if (same_line[line] == line) continue;
    result[line] = result[same_line[line]] = 1;
    any = true;
  }
  if (!any) result.clear();
  return result;
}

}  // namespace meshgrain
