#include "symmetry/chords_of_plane.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "measure/face_shape.h"

namespace meshgrain {
namespace {

/// Where an edge that joins two vertices of the plane is a side of a face.
struct PlaneSide {
  Index face;
  std::size_t corner;  // that the side starts at
};

/// Edges inside of the mesh that join two vertices of the plane, with their sides.
std::map<std::pair<Index, Index>, std::vector<PlaneSide>> find_chords(
    const Mesh& mesh, const std::vector<std::uint8_t>& on_plane) {
  std::map<std::pair<Index, Index>, std::vector<PlaneSide>> sides;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index a = face[k], b = face[(k + 1) % face.size()];
      if (on_plane[a] && on_plane[b]) sides[std::minmax(a, b)].push_back({f, k});
    }
  }
  std::erase_if(sides, [](const auto& edge) { return edge.second.size() < 2; });
  return sides;
}

bool all_have(const Mesh& mesh, std::size_t degree) {
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (mesh.faces.degree(f) != degree) return false;
  }
  return true;
}

/// Adds the vertex for a chord from a to b: where that would be on the plane, as far off it as a
/// round limb would be there.
void add_vertex(Mesh& mesh, Vec3 position, Index a, Index b, int axis,
                std::vector<std::uint8_t>& on_plane) {
  if (position[axis] == 0) position[axis] = (mesh.positions[a] - mesh.positions[b]).norm() / 2;
  mesh.positions.push_back(position);
  if (!mesh.normals.empty()) mesh.normals.push_back(Vec3(mesh.normals[a]));
  on_plane.push_back(0);
}

/// Of a mesh of quads: the two at a chord become three around a new vertex.
void open_chords(Mesh& mesh, std::vector<std::uint8_t>& on_plane, int axis) {
  for (auto chords = find_chords(mesh, on_plane); !chords.empty();
       chords = find_chords(mesh, on_plane)) {
    const std::vector<PlaneSide>& sides = chords.begin()->second;
    std::array<Index, 6> around;  // both quads together
    for (const std::size_t side : {0, 1}) {
      const auto face = std::as_const(mesh.faces)[sides[side].face];
      for (std::size_t k = 0; k < 3; ++k) {
        around[3 * side + k] = face[(sides[side].corner + 1 + k) % 4];
      }
    }
    Vec3 middle = Vec3::Zero();
    for (const Index v : around) middle += mesh.positions[v] / 6;
    const auto center = static_cast<Index>(mesh.positions.size());
    const auto [a, b] = chords.begin()->first;
    add_vertex(mesh, middle, a, b, axis, on_plane);
    const auto quad = [&](std::size_t first) {
      return std::array<Index, 4>{center, around[first % 6], around[(first + 1) % 6],
                                  around[(first + 2) % 6]};
    };
    const auto worst = [&](std::size_t first) {
      float least = 1;
      for (const std::size_t k : {0, 2, 4}) {
        const auto corners = quad(first + k);
        const Vec3 normal = area_vector(corners, mesh.positions).normalized();
        least = std::min(least, least_sine(corners, mesh.positions, normal));
      }
      return least;
    };
    const std::size_t first = worst(0) < worst(1) ? 1 : 0;
    for (const std::size_t side : {0, 1}) {
      std::ranges::copy(quad(first + 2 * side), mesh.faces[sides[side].face].begin());
    }
    mesh.faces.push_back(quad(first + 4));
  }
}

/// Of the corners of the faces at a chord over the plane.
float mean_height(const Mesh& mesh, const std::vector<PlaneSide>& sides, int axis) {
  float sum = 0, corners = 0;
  for (const PlaneSide& side : sides) {
    for (const Index v : std::as_const(mesh.faces)[side.face]) {
      sum += mesh.positions[v][axis];
      ++corners;
    }
  }
  return sum / corners;
}

/// Of any mesh: they are halved. Triangles stay triangles.
void split_chords(Mesh& mesh, std::vector<std::uint8_t>& on_plane, int axis) {
  const bool triangles = all_have(mesh, 3);
  std::map<std::pair<Index, Index>, Index> middles;
  for (const auto& [edge, sides] : find_chords(mesh, on_plane)) {
    const auto [a, b] = edge;
    Vec3 middle = 0.5f * (mesh.positions[a] + mesh.positions[b]);
    middle[axis] = mean_height(mesh, sides, axis);
    middles[edge] = static_cast<Index>(mesh.positions.size());
    add_vertex(mesh, middle, a, b, axis, on_plane);
  }
  if (middles.empty()) return;
  Faces faces;
  std::vector<Index> corners;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = std::as_const(mesh.faces)[f];
    corners.clear();
    std::size_t last_added = 0;
    for (std::size_t k = 0; k < face.size(); ++k) {
      corners.push_back(face[k]);
      const auto it = middles.find(std::minmax(face[k], face[(k + 1) % face.size()]));
      if (it == middles.end()) continue;
      last_added = corners.size();
      corners.push_back(it->second);
    }
    if (!triangles || corners.size() == 3) {
      faces.push_back(corners);
      continue;
    }
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(last_added),
                corners.end());
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      faces.push_back({corners[0], corners[k], corners[k + 1]});
    }
  }
  mesh.faces = std::move(faces);
}

}  // namespace

void take_away_chords(Mesh& half, std::vector<std::uint8_t>& on_plane, int axis) {
  if (all_have(half, 4)) {
    open_chords(half, on_plane, axis);
  } else {
    split_chords(half, on_plane, axis);
  }
}

}  // namespace meshgrain
