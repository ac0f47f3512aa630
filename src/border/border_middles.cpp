#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "border/lock_borders.h"
#include "extract/drop_unused.h"
#include "extract/line_edges.h"
#include "mesh/border.h"
#include "mesh/vertex_faces.h"

namespace meshgrain {
namespace {

/// A vertex of the border, and those before and after it as its faces go around.
struct Middle {
  Index before, vertex, after;
};

/// The locked vertex between two others that follow each other around a hole, or none.
std::optional<Index> node_between(const BorderLoops& borders, Index from, Index to) {
  for (const auto& a : borders.places_of(from)) {
    const std::vector<Index>& locked = borders.loops[a.loop].locked;
    const std::size_t next = (static_cast<std::size_t>(a.place) + 1) % locked.size();
    if (locked[(next + 1) % locked.size()] == to && locked[next] != to) return locked[next];
  }
  return std::nullopt;
}

/// Vertices of the border that `wanted` says yes to.
template <typename Wanted>
std::vector<Middle> border_middles(const Mesh& mesh, const Wanted& wanted) {
  std::map<Index, Middle> found;
  for (const auto& [a, b] : border_edges(mesh)) {
    found.try_emplace(a, Middle{no_index, a, no_index}).first->second.after = b;
    found.try_emplace(b, Middle{no_index, b, no_index}).first->second.before = a;
  }
  std::vector<Middle> result;
  for (const auto& [vertex, middle] : found) {
    if (middle.before != no_index && middle.after != no_index && wanted(middle)) {
      result.push_back(middle);
    }
  }
  return result;
}

/// Whether the faces allow that a vertex is merged into a neighbour on the border.
bool may_merge(const Mesh& mesh, const VertexFaces& around, Index gone, Index kept) {
  const auto has = [&](Index f, Index v) {
    return std::ranges::find(std::as_const(mesh.faces)[f], v) != std::as_const(mesh.faces)[f].end();
  };
  const auto beside = [&](Index v) {
    std::vector<Index> result;
    for (const Index f : around[v]) {
      const auto face = std::as_const(mesh.faces)[f];
      for (std::size_t k = 0; k < face.size(); ++k) {
        if (face[k] != v) continue;
        result.push_back(face[(k + 1) % face.size()]);
        result.push_back(face[(k + face.size() - 1) % face.size()]);
      }
    }
    return result;
  };
  const std::vector<Index> near = beside(kept);
  for (const Index v : beside(gone)) {
    if (v != kept && std::ranges::find(near, v) != near.end()) return false;
  }
  for (const Index f : around[gone]) {
    const auto face = std::as_const(mesh.faces)[f];
    if (has(f, kept) && face.size() <= 3) return false;
  }
  return true;
}

/// Faces with vertices that became others, or no_index, and none of them twice in a row.
void merge_vertices(Faces& faces, const std::vector<Index>& into) {
  Faces merged;
  std::vector<Index> corners;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    corners.clear();
    for (const Index v : std::as_const(faces)[f]) {
      const Index to = into[v] == no_index ? v : into[v];
      if (corners.empty() || corners.back() != to) corners.push_back(to);
    }
    if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    merged.push_back(corners);
  }
  faces = std::move(merged);
}

}  // namespace

void lock_middles(Extraction& extraction, const BorderLoops& borders, const Graph& graph) {
  if (borders.empty()) return;
  Mesh& mesh = extraction.mesh;
  const std::vector<std::uint8_t> hold = held_vertices(extraction);
  const auto is_new = [&](const Middle& m) { return hold[m.vertex] != at_corner; };
  for (const auto& [before, v, after] : border_middles(mesh, is_new)) {
    // Faces go around the other way than the hole.
    const Index from = extraction.nodes[after], to = extraction.nodes[before];
    const std::optional<Index> node = node_between(borders, from, to);
    extraction.nodes[v] = node.value_or(to);
    extraction.corners.push_back(v);
    if (!node) continue;
    mesh.positions[v] = graph.positions[*node];
    mesh.normals[v] = graph.normals[*node];
  }
}

void drop_spare_middles(Extraction& extraction) {
  Mesh& mesh = extraction.mesh;
  const auto& nodes = extraction.nodes;
  const auto is_spare = [&](const Middle& m) { return nodes[m.vertex] == nodes[m.before]; };
  for (bool again = true; std::exchange(again, false);) {
    const std::vector<Middle> spare = border_middles(mesh, is_spare);
    if (spare.empty()) break;
    const VertexFaces around = vertex_faces(mesh);
    std::vector<Index> into(mesh.positions.size(), no_index);
    std::vector<std::uint8_t> has_changed(mesh.faces.size(), 0);
    const auto is_as_it_was = [&](Index v) {
      return std::ranges::all_of(around[v], [&](Index f) { return !has_changed[f]; });
    };
    // Those beside each other take turns: what was said of the faces between them no longer holds.
    for (const auto& [before, v, after] : spare) {
      for (const Index kept : {before, after}) {
        if (!is_as_it_was(v) || !is_as_it_was(kept)) {
          again = true;
          break;
        }
        if (!may_merge(mesh, around, v, kept)) continue;
        into[v] = kept;
        for (const Index w : {v, kept}) {
          for (const Index f : around[w]) has_changed[f] = 1;
        }
        again = true;
        break;
      }
    }
    std::erase_if(extraction.corners, [&](Index v) { return into[v] != no_index; });
    if (again) merge_vertices(mesh.faces, into);
  }
  drop_unused(extraction);
}

void join_locked(Extraction& extraction) {
  Mesh& mesh = extraction.mesh;
  std::vector<Index> into(mesh.positions.size());
  for (Index v = 0; v < into.size(); ++v) into[v] = v;
  const auto on_border = mark_ends(border_edges(mesh), mesh.positions.size());
  std::map<Index, Index> first;  // of each node
  bool any = false;
  for (const Index v : extraction.corners) {
    if (!on_border[v]) continue;
    const auto [it, is_new] = first.try_emplace(extraction.nodes[v], v);
    into[v] = it->second;
    any = any || into[v] != v;
  }
  if (!any) return;
  // Not where a face would touch itself.
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = std::as_const(mesh.faces)[f];
    for (std::size_t i = 0; i < face.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (into[face[i]] != into[face[j]]) continue;
        into[face[i]] = face[i];
        into[face[j]] = face[j];
      }
    }
  }
  for (Index& v : mesh.faces.corners()) v = into[v];
  for (LineEdge& edge : extraction.line_edges) {
    edge = {into[edge.a], into[edge.b], edge.line};
  }
  for (Index& v : extraction.corners) v = into[v];
  std::ranges::sort(extraction.corners);
  const auto repeated = std::ranges::unique(extraction.corners);
  extraction.corners.erase(repeated.begin(), repeated.end());
  drop_unused(extraction);
}

}  // namespace meshgrain
