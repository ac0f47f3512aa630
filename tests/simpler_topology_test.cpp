#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "has_note.h"
#include "mesh/border.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

/// Cuts a closed surface open along two edges around each of some vertices that lie apart: those on
/// one side get a vertex of their own, at the same place.
std::size_t cut_slits(Mesh& mesh, std::size_t most) {
  const VertexFaces around = vertex_faces(mesh);
  std::vector<bool> is_near(mesh.positions.size(), false);
  std::size_t count = 0;
  const auto vertices = static_cast<Index>(mesh.positions.size());
  for (Index v = 0; v < vertices && count < most; ++v) {
    std::map<Index, std::array<Index, 2>>
        next;  // around v: the next neighbor, and the face between
    bool is_free = !is_near[v];
    for (const Index f : around[v]) {
      const auto corners = std::as_const(mesh.faces)[f];
      const auto at = std::ranges::find(corners, v) - corners.begin();
      const Index after = corners[static_cast<std::size_t>(at + 1) % 3];
      next[after] = {corners[static_cast<std::size_t>(at + 2) % 3], f};
      is_free = is_free && !is_near[after];
    }
    if (!is_free) continue;
    const auto copy = static_cast<Index>(mesh.positions.size());
    mesh.positions.push_back(mesh.positions[v]);
    Index w = next.begin()->first;
    for (std::size_t k = 0; k < next.size() / 2; ++k) {
      const auto [neighbor, face] = next[w];
      std::ranges::replace(mesh.faces[face], v, copy);
      w = neighbor;
    }
    is_near[v] = true;
    for (const auto& [neighbor, beside] : next) is_near[neighbor] = true;
    ++count;
  }
  return count;
}

constexpr std::size_t many_slits = 200;

/// Of a torus with slits that are shorter than faces, as there are between the parts of a scan, and
/// what else it has.
RemeshResult expect_closed_slits(const Mesh& input, const Mesh& whole) {
  EXPECT_EQ(mesh_statistics(input).boundary_loops,
            many_slits + mesh_statistics(whole).boundary_loops);
  RemeshOptions options;
  options.face_count = 400;
  RemeshResult coarse = remesh(input, options);
  const MeshStatistics s = mesh_statistics(coarse.mesh);
  made::expect_same_topology(s, mesh_statistics(whole));
  EXPECT_EQ(s.inverted_quads, 0u);
  EXPECT_NEAR(static_cast<double>(s.faces), 400, 4);
  EXPECT_TRUE(made::has_note(coarse, "merged 200 vertices along seams"));
  EXPECT_EQ(coarse.report.input_vertices, input.positions.size());
  return coarse;
}

auto times_of(const RemeshResult& result, const std::string& stage) {
  return std::ranges::count(result.report.stages, stage, &StageTime::name);
}

TEST(SimplerTopology, ShortSlitsAloneAreClosedAtOnce) {
  const Mesh whole = sample_shape("torus");
  Mesh input = whole;
  ASSERT_EQ(cut_slits(input, many_slits), many_slits);
  const RemeshResult coarse = expect_closed_slits(input, whole);
  EXPECT_EQ(times_of(coarse, "clean"), 1);
  EXPECT_EQ(times_of(coarse, "join seams"), 0);
}

Mesh without_face(const Mesh& mesh, std::size_t gone) {
  Mesh result = mesh;
  result.faces = {};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (f != gone) result.faces.push_back(mesh.faces[f]);
  }
  return result;
}

/// With a hole besides, all are kept at first.
TEST(SimplerTopology, SlitsAreClosedWhereTheyWouldSpoilFaces) {
  const Mesh whole = sample_shape("torus");
  Mesh input = whole;
  ASSERT_EQ(cut_slits(input, many_slits), many_slits);
  const auto on_slit = mark_ends(border_edges(input), input.positions.size());
  std::size_t f = 0;  // away from them
  while (std::ranges::any_of(std::as_const(input.faces)[f],
                             [&](Index v) { return on_slit[v] != 0; })) {
    ASSERT_LT(++f, input.faces.size());
  }
  const RemeshResult coarse = expect_closed_slits(without_face(input, f), without_face(whole, f));
  EXPECT_EQ(times_of(coarse, "join seams"), 1);
}

TEST(SimplerTopology, SlitsStayWhereThereIsRoom) {
  Mesh input = sample_shape("torus");
  constexpr std::size_t slits = 20;
  ASSERT_EQ(cut_slits(input, slits), slits);
  RemeshOptions options;
  options.face_count = 5'000;
  const RemeshResult result = remesh(input, options);
  made::expect_same_topology(mesh_statistics(result.mesh), mesh_statistics(input));
  EXPECT_EQ(mesh_statistics(result.mesh).inverted_quads, 0u);
}

/// A closed surface as programs write it that keep several texture coordinates at a vertex.
Mesh cut_into_charts(const Mesh& whole) {
  Mesh charts;
  std::map<std::pair<int, Index>, Index> vertex;
  for (std::size_t f = 0; f < whole.faces.size(); ++f) {
    const auto face = whole.faces[f];
    Vec3 middle = Vec3::Zero();
    for (const Index v : face) middle += whole.positions[v];
    const int chart = (middle.x() > 0) + 2 * (middle.y() > 0) + 4 * (middle.z() > 0);
    std::vector<Index> corners;
    for (const Index v : face) {
      const auto [it, is_new] =
          vertex.try_emplace({chart, v}, static_cast<Index>(charts.positions.size()));
      if (is_new) charts.positions.push_back(whole.positions[v]);
      corners.push_back(it->second);
    }
    charts.faces.push_back(corners);
  }
  return charts;
}

TEST(SimplerTopology, ChartsOfAClosedSurfaceAreJoinedAtAnyCount) {
  const Mesh whole = sample_shape("blob", 0.1);
  const Mesh charts = cut_into_charts(whole);
  ASSERT_GT(mesh_statistics(charts).boundary_loops, 4u);
  RemeshOptions options;
  for (const std::size_t count : {300, 1000, 3000}) {
    SCOPED_TRACE(count);
    options.face_count = count;
    const RemeshResult result = remesh(charts, options);
    const MeshStatistics now = mesh_statistics(result.mesh);
    made::expect_same_topology(now, mesh_statistics(whole));
    EXPECT_GT(now.jacobian_p01, 0.7);
    EXPECT_TRUE(made::has_note(result, "merged "));
  }
}

/// The sine of a full turn is not that of none.
TEST(SimplerTopology, SeamsAreSeenThroughRounding) {
  Mesh charts = cut_into_charts(sample_shape("sphere", 0.2));
  bool any = false;
  for (std::size_t v = 0; v < charts.positions.size(); v += 2) {
    for (float& x : charts.positions[v]) {
      any = any || x == 0;
      if (x == 0) x = -2.4e-16f;
    }
  }
  ASSERT_TRUE(any);
  RemeshOptions options;
  options.face_count = 1000;
  EXPECT_EQ(mesh_statistics(remesh(charts, options).mesh).boundary_loops, 0u);
}

}  // namespace
}  // namespace meshgrain
