#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "mesh/border.h"
#include "mesh/keep_vertices.h"
#include "mesh/pieces.h"
#include "meshgrain/clean.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "meshgrain/symmetry.h"
#include "meshgrain/triangulate.h"
#include "symmetry/chords_of_plane.h"
#include "util/edge_of.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

/// Drops faces with all corners on the plane, which lie between the halves and in neither, as long
/// as the rest hangs together as before: those with all sides but one on the border.
void drop_ears(Mesh& mesh, const std::vector<std::uint8_t>& on_plane) {
  const Faces& faces = mesh.faces;
  std::vector<std::size_t> flat;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (std::ranges::all_of(faces[f], [&](Index v) { return on_plane[v] != 0; })) flat.push_back(f);
  }
  if (flat.empty()) return;
  std::map<std::array<Index, 2>, int> uses;
  const auto for_sides = [&](std::size_t f, const auto& body) {
    const auto face = faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      body(uses[edge_of(face[k], face[(k + 1) % face.size()])]);
    }
  };
  for (std::size_t f = 0; f < faces.size(); ++f) for_sides(f, [](int& count) { ++count; });
  std::vector<std::uint8_t> is_dropped(faces.size(), 0);
  const auto drop = [&](std::size_t f) {
    std::size_t inner = 0;
    for_sides(f, [&](int count) { inner += count > 1; });
    if (inner > 1) return false;
    for_sides(f, [](int& count) { --count; });
    is_dropped[f] = 1;
    return true;
  };
  while (std::erase_if(flat, drop) > 0) continue;
  Faces kept;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!is_dropped[f]) kept.push_back(faces[f]);
  }
  mesh.faces = std::move(kept);
}

/// Drops what a cut has parted from the rest of a piece and is tiny beside it: where a shape is not
/// exactly symmetric, as on a leg that crosses the plane by a little. `whole`: pieces before the
/// cut, of the vertices that there were.
void drop_crumbs(Mesh& mesh, UnionFind& whole, std::size_t vertices) {
  constexpr double tiny = 1e-3;  // of the area
  UnionFind parts = pieces_of(mesh);
  std::map<Index, double> area;     // of parts
  std::map<Index, Index> source;    // of parts: the piece before
  std::map<Index, double> largest;  // of these: the area of a part
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Index part = parts.find(mesh.faces[f][0]);
    area[part] += face_area(mesh, f);
    for (const Index v : std::as_const(mesh.faces)[f]) {
      if (v < vertices) source[part] = whole.find(v);
    }
  }
  for (const auto& [part, piece] : source) largest[piece] = std::max(largest[piece], area[part]);
  Faces kept;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Index part = parts.find(mesh.faces[f][0]);
    if (area[part] > tiny * largest[source[part]]) kept.push_back(std::as_const(mesh.faces)[f]);
  }
  mesh.faces = std::move(kept);
}

/// A function that gives the distances of a mesh's vertices from a plane: 0 if they are hardly off
/// it.
auto heights_over(const MirrorPlane& plane, const Mesh& mesh) {
  return [plane, tiny = 1e-5 * bounding_diagonal(mesh)](const Vec3& p) {
    const double d = p[plane.axis] - plane.offset;
    return std::abs(d) < tiny ? 0.0f : static_cast<float>(d);
  };
}

}  // namespace

std::size_t count_faces_in(const Mesh& mesh, const MirrorPlane& plane) {
  const auto height = heights_over(plane, mesh);
  std::size_t count = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    count +=
        std::ranges::all_of(mesh.faces[f], [&](Index v) { return height(mesh.positions[v]) == 0; });
  }
  return count;
}

void cut_at(Mesh& mesh, const MirrorPlane& plane) {
  const int axis = plane.axis;
  const auto height = heights_over(plane, mesh);
  mesh.origin[axis] += plane.offset;
  for (Vec3& p : mesh.positions) p[axis] = height(p);
  UnionFind whole = pieces_of(mesh);
  const std::size_t vertices = mesh.positions.size();
  std::map<std::pair<Index, Index>, Index> crossings;
  const auto cross = [&](Index a, Index b) {
    const auto [it, is_new] =
        crossings.try_emplace(std::minmax(a, b), static_cast<Index>(mesh.positions.size()));
    if (is_new) {
      std::tie(a, b) = it->first;
      const float share =
          mesh.positions[a][axis] / (mesh.positions[a][axis] - mesh.positions[b][axis]);
      Vec3 p = mesh.positions[a] + share * (mesh.positions[b] - mesh.positions[a]);
      p[axis] = 0;
      mesh.positions.push_back(p);
      if (!mesh.values.empty()) {
        mesh.values.push_back(mesh.values[a] + share * (mesh.values[b] - mesh.values[a]));
      }
    }
    return it->second;
  };
  mesh.normals.clear();  // those of a mesh are its own
  Faces above;
  std::vector<Index> corners;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = std::as_const(mesh.faces)[f];
    corners.clear();
    bool any = false;
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index a = face[k], b = face[(k + 1) % face.size()];
      const float from = mesh.positions[a][axis], to = mesh.positions[b][axis];
      any = any || from > 0;
      if (from >= 0) corners.push_back(a);
      if ((from > 0 && to < 0) || (from < 0 && to > 0)) corners.push_back(cross(a, b));
    }
    if (any && corners.size() >= 3) above.push_back(corners);
  }
  for (auto& [a, b] : mesh.marked_edges) {
    const float from = mesh.positions[a][axis], to = mesh.positions[b][axis];
    if ((from > 0 && to < 0) || (from < 0 && to > 0)) (from < 0 ? a : b) = cross(a, b);
  }
  mesh.faces = std::move(above);
  drop_crumbs(mesh, whole, vertices);
  mesh = triangulate(mesh);
  clean(mesh);  // the vertices and marked edges of the other half
}

void add_mirror_image(Mesh& mesh, int axis, double near) {
  std::vector<std::uint8_t> on_plane(mesh.positions.size(), 0);
  for (const auto& edge : border_edges(mesh)) {
    for (const Index v : edge) {
      if (std::abs(mesh.positions[v][axis]) >= near) continue;
      mesh.positions[v][axis] = 0;
      on_plane[v] = 1;
    }
  }
  mesh.values.clear();  // those of the other half are not known
  drop_ears(mesh, on_plane);
  take_away_chords(mesh, on_plane, axis);
  const auto count = static_cast<Index>(mesh.positions.size());
  std::vector<Index> image(count);
  for (Index v = 0; v < count; ++v) {
    if (on_plane[v]) {
      image[v] = v;
      if (!mesh.normals.empty()) mesh.normals[v][axis] = 0;
      continue;
    }
    image[v] = static_cast<Index>(mesh.positions.size());
    Vec3 p = mesh.positions[v];
    p[axis] = -p[axis];
    mesh.positions.push_back(p);
    if (!mesh.normals.empty()) {
      Vec3 n = mesh.normals[v];
      n[axis] = -n[axis];
      mesh.normals.push_back(n);
    }
  }
  const std::size_t faces = mesh.faces.size();
  std::vector<Index> corners;
  for (std::size_t f = 0; f < faces; ++f) {
    const auto face = std::as_const(mesh.faces)[f];
    corners.assign(face.rbegin(), face.rend());
    for (Index& v : corners) v = image[v];
    mesh.faces.push_back(corners);
  }
  const std::size_t marks = mesh.marked_edges.size();
  for (std::size_t e = 0; e < marks; ++e) {
    const auto [a, b] = mesh.marked_edges[e];
    if (image[a] != a || image[b] != b) mesh.marked_edges.push_back({image[a], image[b]});
  }
  drop_unused_vertices(mesh, Context(1));
}

}  // namespace meshgrain
