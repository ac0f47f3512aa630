#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "has_note.h"
#include "measure/crossings.h"
#include "meshgrain/remesh.h"
#include "meshgrain/statistics.h"
#include "meshgrain/triangulate.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

/// A slab of 20 by 20 with plates standing on it, whose rims are so far apart. Its outline, from
/// its front to its back.
Mesh heat_sink(int plates, float thickness) {
  constexpr float half = 10, base = 2, height = 8;
  const float pitch = 2 * half / static_cast<float>(plates);
  std::vector<std::array<float, 2>> outline{{-half, 0}, {half, 0}, {half, base}};
  for (int k = plates; k-- > 0;) {
    const float left = -half + (static_cast<float>(k) + 0.5f) * pitch - thickness / 2;
    const float right = left + thickness;
    for (const auto& p : {std::array{right, base}, std::array{right, base + height},
                          std::array{left, base + height}, std::array{left, base}}) {
      outline.push_back(p);
    }
  }
  outline.push_back({-half, base});
  Mesh mesh;
  const auto n = static_cast<Index>(outline.size());
  for (const float z : {-half, half}) {
    for (const auto& [x, y] : outline) mesh.positions.emplace_back(x, y, z);
  }
  std::vector<Index> front, back;
  for (Index k = 0; k < n; ++k) {
    const Index next = (k + 1) % n;
    mesh.faces.push_back(std::array{k, next, n + next, n + k});
    front.push_back(n + k);
    back.push_back(n - 1 - k);
  }
  mesh.faces.push_back(front);
  mesh.faces.push_back(back);
  return triangulate(mesh);
}

/// How many vertices of a mesh are far from all of another's.
std::size_t count_lost(const Mesh& mesh, const Mesh& among, float far) {
  return static_cast<std::size_t>(std::ranges::count_if(mesh.positions, [&](const Vec3& p) {
    return std::ranges::none_of(among.positions,
                                [&](const Vec3& q) { return (p - q).norm() < far; });
  }));
}

/// From a quarter of a face's side on, which would leave no room in the lattice, to a whole one.
TEST(ThinPlates, HaveARowOfFacesOnTheirRimsAndAllCorners) {
  constexpr int plates = 3;
  constexpr std::size_t count = 700;
  for (const float share : {0.25f, 0.35f, 0.45f, 0.6f, 0.8f, 1.0f}) {
    constexpr float side = 1.7f;
    const Mesh plate = heat_sink(plates, share * side);
    for (const OutputFaces faces : {OutputFaces::quads, OutputFaces::quad_dominant}) {
      SCOPED_TRACE(std::to_string(share) + " " + std::to_string(static_cast<int>(faces)));
      RemeshOptions options;
      options.faces = faces;
      options.face_count = count;
      const Mesh result = remesh(plate, options).mesh;
      const MeshStatistics after = mesh_statistics(result);
      made::expect_same_topology(after, mesh_statistics(plate));
      EXPECT_EQ(after.inverted_quads, 0u);
      EXPECT_EQ(count_lost(plate, result, 0.01f), 0u);
      // Eight corners of the slab and four of each plate at least have three edges, and as many
      // vertices five for them.
      EXPECT_LE(after.irregular_vertices, 60u);
    }
  }
}

/// Cancelling all that it may bends the grid between the creases until faces turn over.
TEST(ThinPlates, RegularityYieldsToSoundFaces) {
  std::size_t yielding = 0;
  for (const auto& [thickness, count] : {std::pair(0.5f, 300), std::pair(0.4f, 700)}) {
    const Mesh plate = heat_sink(5, thickness);
    SCOPED_TRACE(std::to_string(thickness) + " " + std::to_string(count));
    RemeshOptions options;
    options.face_count = static_cast<std::size_t>(count);
    options.regularity = 1;
    const RemeshResult result = remesh(plate, options);
    EXPECT_EQ(mesh_statistics(result.mesh).inverted_quads, 0u);
    EXPECT_TRUE(find_crossings(result.mesh, Context()).empty());
    yielding += made::has_note(result, "less regular");
  }
  EXPECT_GT(yielding, 0u);
}

}  // namespace
}  // namespace meshgrain
