#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "finish/bare_ends.h"
#include "finish/fit_to_rails.h"
#include "finish/fit_to_surface.h"
#include "finish/go_around.h"
#include "finish/placement.h"
#include "finish/turned_over.h"
#include "finish/unfold.h"
#include "finish/untwist.h"
#include "measure/crossings.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/triangulate.h"
#include "same_topology.h"
#include "util/triangle.h"

namespace meshgrain {
namespace {

Mesh two_triangles(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  Mesh mesh;
  mesh.positions.assign(a.begin(), a.end());
  mesh.positions.insert(mesh.positions.end(), b.begin(), b.end());
  mesh.faces.push_back(std::array<Index, 3>{0, 1, 2});
  mesh.faces.push_back(std::array<Index, 3>{3, 4, 5});
  return mesh;
}

const std::array<Vec3, 3> flat{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};

TEST(Crossings, AnEdgeThroughAFace) {
  const Mesh mesh =
      two_triangles(flat, {Vec3(0.2f, 0.2f, -0.1f), Vec3(0.2f, 0.2f, 0.5f), Vec3(2, 2, 0.5f)});
  EXPECT_GT(penetration(mesh, 0, 1), 0.1);
  EXPECT_EQ(penetration(mesh, 0, 1), penetration(mesh, 1, 0));
  EXPECT_EQ(find_crossings(mesh, Context()).size(), 1u);
}

TEST(Crossings, BesideAndAboveIsApart) {
  for (const Vec3& away : {Vec3(0, 0, 0.01f), Vec3(2, 0, 0), Vec3(0, -1.1f, 0.2f)}) {
    std::array<Vec3, 3> other = flat;
    for (Vec3& p : other) p += away;
    const Mesh mesh = two_triangles(flat, other);
    EXPECT_EQ(penetration(mesh, 0, 1), 0) << away.transpose();
    EXPECT_TRUE(find_crossings(mesh, Context()).empty());
  }
}

/// Faces of very different sizes meet in the cells of the finder's grid too.
TEST(Crossings, AreFoundInAnyOrderAndSize) {
  Mesh mesh = sample_shape("sphere", 0.5);
  EXPECT_TRUE(find_crossings(mesh, Context()).empty());
  const auto first = static_cast<Index>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {Vec3(-9, -9, 0), Vec3(9, -9, 0), Vec3(0, 20, 0)});
  mesh.faces.push_back(std::array<Index, 3>{first, first + 1, first + 2});
  const auto plane = static_cast<Index>(mesh.faces.size() - 1);
  const auto found = find_crossings(mesh, Context());
  std::size_t expected = 0;
  for (Index f = 0; f < plane; ++f) expected += penetration(mesh, f, plane) > 0;
  EXPECT_GT(expected, 10u);
  EXPECT_EQ(found.size(), expected);
}

/// The surface that a profile (radius, height) from axis to axis sweeps around the z-axis.
Mesh turned(const std::vector<std::array<double, 2>>& profile, Index around) {
  Mesh mesh;
  const auto rows = static_cast<Index>(profile.size()) - 2;  // between the poles
  mesh.positions.push_back(Vec3(0, 0, static_cast<float>(profile.front()[1])));
  for (Index r = 1; r <= rows; ++r) {
    for (Index k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      mesh.positions.push_back(Eigen::Vector3d(profile[r][0] * std::cos(angle),
                                               profile[r][0] * std::sin(angle), profile[r][1])
                                   .cast<float>());
    }
  }
  mesh.positions.push_back(Vec3(0, 0, static_cast<float>(profile.back()[1])));
  const auto last = static_cast<Index>(mesh.positions.size() - 1);
  const auto at = [&](Index row, Index k) { return 1 + (row - 1) * around + k % around; };
  for (Index k = 0; k < around; ++k) {
    mesh.faces.push_back(std::array<Index, 3>{0, at(1, k + 1), at(1, k)});
    mesh.faces.push_back(std::array<Index, 3>{last, at(rows, k), at(rows, k + 1)});
    for (Index r = 1; r < rows; ++r) {
      mesh.faces.push_back(
          std::array<Index, 4>{at(r, k), at(r, k + 1), at(r + 1, k + 1), at(r + 1, k)});
    }
  }
  return mesh;
}

Mesh remeshed(const Mesh& mesh, std::size_t count, OutputFaces faces = OutputFaces::quads) {
  RemeshOptions options;
  options.face_count = count;
  options.faces = faces;
  return remesh(mesh, options).mesh;
}

/// A bowl whose wall is thinner than the faces are wide.
TEST(Finish, ThinWallsDoNotPassThroughEachOther) {
  std::vector<std::array<double, 2>> profile;
  constexpr int steps = 60;
  constexpr double wall = 0.06;
  for (int k = 0; k <= steps; ++k) {
    const double angle = std::numbers::pi / 2 * k / steps;
    profile.push_back({std::sin(angle), -std::cos(angle)});
  }
  for (int k = steps; k >= 0; --k) {
    const double angle = std::numbers::pi / 2 * k / steps;
    profile.push_back({(1 - wall) * std::sin(angle), -(1 - wall) * std::cos(angle)});
  }
  profile.front()[0] = profile.back()[0] = 0;
  const Mesh bowl = turned(profile, 200);
  ASSERT_TRUE(find_crossings(bowl, Context()).empty());
  for (const std::size_t count : {1000, 2000, 4000}) {
    for (const OutputFaces faces : {OutputFaces::quads, OutputFaces::triangles}) {
      SCOPED_TRACE(testing::Message() << count << " faces of kind " << static_cast<int>(faces));
      const Mesh result = remeshed(bowl, count, faces);
      made::expect_same_topology(mesh_statistics(result), mesh_statistics(bowl));
      EXPECT_TRUE(find_crossings(result, Context()).empty());
    }
  }
}

/// A bellows with folds narrower than the faces, which pass through each other until they are
/// mended. There they look at each other from afar.
TEST(Finish, AnyNumberOfThreadsMendsAlike) {
  std::vector<std::array<double, 2>> profile;
  constexpr int folds = 8, steps = 16 * folds;
  profile.push_back({0, -1});
  for (int k = 0; k <= steps; ++k) {
    const double turn = 2 * std::numbers::pi * folds * k / steps;
    profile.push_back({0.65 + 0.15 * std::cos(turn), 2.0 * k / steps - 1});
  }
  profile.push_back({0, 1});
  const Mesh bellows = turned(profile, 60);
  const tbb::global_control many(tbb::global_control::max_allowed_parallelism, 8);
  RemeshOptions options;
  options.face_count = 500;
  const Mesh one = remesh(bellows, options, Context(1)).mesh;
  for (const int threads : {2, 3, 8}) {
    const Mesh mesh = remesh(bellows, options, Context(threads)).mesh;
    EXPECT_EQ(mesh.positions, one.positions) << threads;
    EXPECT_TRUE(std::ranges::equal(mesh.faces.corners(), one.faces.corners())) << threads;
  }
}

/// Both ends of the line are at the same place, and the vertices there are corners.
TEST(Finish, ChordsKnowWhichEndIsMeant) {
  FeatureLines line;
  line.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}};
  line.vertices = {0, 1, 2, 3, 4};
  line.starts.push_back(5);
  line.corners = {0, 4};
  Extraction loop;
  loop.mesh.positions = line.positions;
  loop.nodes = line.vertices;
  loop.corners = {0, 4};
  for (Index k = 0; k < 4; ++k) loop.line_edges.push_back({k, k + 1, 0});
  const Rails rails(loop, line);
  const Chords chords(loop.mesh, loop.line_edges, rails);
  EXPECT_EQ(chords.way(0, 0, 1), 0);
  EXPECT_EQ(chords.way(4, 0, 3), 4);
  for (const Index v : {1, 2, 3}) EXPECT_EQ(chords.cut_off(v), 0) << v;
  loop.mesh.positions[3] = {0, 0.97f, 0};  // cuts the corner off at (0, 1), but not by much
  EXPECT_EQ(chords.cut_off(3), 0);
  loop.mesh.positions[3] = {0, 0.5f, 0};
  EXPECT_GT(chords.cut_off(3), 0.02);
}

/// A circle of radius 1 in 60 parts, and a cone over a chain of edges around it, seen from above.
struct Ring {
  explicit Ring(const std::vector<double>& degrees) : line(circle()), cone(cone_over(degrees)) {}

  static constexpr Index parts = 60;
  static FeatureLines circle() {
    FeatureLines line;
    for (Index k = 0; k <= parts; ++k) {
      line.vertices.push_back(k % parts);
      line.positions.push_back(at(360.0 * (k % parts) / parts));
    }
    line.starts.push_back(parts + 1);
    return line;
  }
  static Extraction cone_over(const std::vector<double>& degrees) {
    Extraction cone;
    const auto count = static_cast<Index>(degrees.size());
    for (Index k = 0; k < count; ++k) {
      cone.mesh.positions.push_back(at(degrees[k]));
      cone.mesh.faces.push_back({k, (k + 1) % count, count});
      cone.nodes.push_back(static_cast<Index>(degrees[k] / 360 * parts));
      cone.line_edges.push_back({k, (k + 1) % count, 0});
    }
    cone.mesh.positions.emplace_back(0, 0, 1);
    cone.nodes.push_back(parts);
    return cone;
  }
  static Vec3 at(double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0};
  }
  Index count() const { return static_cast<Index>(cone.line_edges.size()); }
  /// From a vertex to the next.
  double step(Index v) const {
    const auto angle = [&](Index w) {
      const Vec3& p = cone.mesh.positions[w];
      return std::atan2(p.y(), p.x()) * 180 / std::numbers::pi;
    };
    const double step = angle((v + 1) % count()) - angle(v);
    return step < 0 ? step + 360 : step;
  }
  void go_around() {
    const auto upward = [](Index) { return Vec3(0, 0, 1); };
    meshgrain::go_around(cone.mesh, vertex_faces(cone.mesh), upward, chords, rails);
  }

  FeatureLines line;
  Extraction cone;
  Rails rails{cone, line};
  Chords chords{cone.mesh, cone.line_edges, rails};
};

/// The middle of the edge that goes the long way around is on the wrong side at first; or all goes
/// the wrong way.
TEST(Finish, ClosedLinesAreFollowedAround) {
  for (const auto& start : {std::vector<double>{80, 90, 100, 113, 126, 150, 193, 137},
                            std::vector<double>{137, 193, 150, 126, 113, 100, 90, 80}}) {
    Ring ring(start);
    ring.go_around();
    for (Index v = 0; v < ring.count(); ++v) EXPECT_NEAR(ring.step(v), 45, 0.5) << v;
  }
  // Those that do follow it stay.
  Ring ring({0, 30, 150, 200, 300});
  const auto before = ring.cone.mesh.positions;
  ring.go_around();
  EXPECT_EQ(ring.cone.mesh.positions, before);
}

/// Two that have changed places: on a large hole it would be far for the others to spread evenly.
TEST(Finish, OnlyVerticesOutOfOrderMoveOnALine) {
  std::vector<double> start{0, 30, 100, 95, 150, 200, 250, 300};
  for (int turn = 0; turn < 8; ++turn) {
    for (const bool is_turned_over : {false, true}) {
      std::vector<double> degrees = start;
      if (is_turned_over) std::reverse(degrees.begin(), degrees.end());
      Ring ring(degrees);
      ring.go_around();
      for (Index v = 0; v < ring.count(); ++v) {
        const bool moves = degrees[v] == 95 || degrees[v] == 100;
        const Vec3 there = Ring::at(moves ? 97.5 : degrees[v]);
        EXPECT_LT((ring.cone.mesh.positions[v] - there).norm(), moves ? 0.06 : 0.01) << v;
        EXPECT_GT(is_turned_over ? 360 - ring.step(v) : ring.step(v), 1) << v;
      }
    }
    std::rotate(start.begin(), start.begin() + 1, start.end());
  }
}

/// All of them try to be where one is.
TEST(Finish, VerticesSlideInOrder) {
  Ring ring({0, 50, 90, 150, 200, 300});
  ring.go_around();
  for (int round = 0; round < 50; ++round) {
    ring.chords.note_ways(Context());
    std::vector<Vec3> next = ring.cone.mesh.positions;
    for (Index v = 0; v < ring.count(); ++v) {
      const auto stop = ring.chords.slide(v, ring.rails.project(Ring::at(120), v));
      ASSERT_TRUE(stop) << v;
      ring.rails.set_place(v, stop->segment);
      next[v] = stop->position;
    }
    ring.cone.mesh.positions = next;
    double around = 0;
    for (Index v = 0; v < ring.count(); ++v) {
      around += ring.step(v);
      ASSERT_LT(ring.step(v), 240) << round;
    }
    ASSERT_NEAR(around, 360, 1e-3) << round;
  }
}

/// A row of quads whose lower side follows a line with spikes.
TEST(Finish, EdgesCutOffLessOfARaggedLine) {
  FeatureLines line;
  line.positions = {{0, 0, 0},    {0.9f, 0, 0},    {1.3f, 0.7f, 0}, {1.7f, 0, 0},
                    {3.2f, 0, 0}, {3.6f, 0.7f, 0}, {4, 0, 0},       {5, 0, 0}};
  for (Index k = 0; k < line.positions.size(); ++k) line.vertices.push_back(k);
  line.starts.push_back(static_cast<Index>(line.positions.size()));
  line.corners = {0, 7};
  Extraction row;
  const std::vector<Vec3> lower = {line.positions[0], {1, 0.175f, 0}, {2, 0, 0},
                                   {3, 0, 0},         {4, 0, 0},      line.positions[7]};
  row.nodes = {0, 1, 3, 3, 6, 7};
  row.corners = {0, 5};
  for (Index k = 0; k < lower.size(); ++k) {
    row.mesh.positions.push_back(lower[k]);
    if (k > 0) row.line_edges.push_back({k - 1, k, 0});
  }
  const auto farthest_spike = [&] {
    float result = 0;
    for (const Index spike : {2, 5}) {
      float nearest = 1;
      for (const auto& [a, b, l] : row.line_edges) {
        const Vec3& p = line.positions[spike];
        const auto q =
            closest_point_on_segment<Vec3>(p, row.mesh.positions[a], row.mesh.positions[b]);
        nearest = std::min(nearest, (q - p).norm());
      }
      result = std::max(result, nearest);
    }
    return result;
  };
  EXPECT_GT(farthest_spike(), 0.5f);
  Rails rails(row, line);
  const Chords chords(row.mesh, row.line_edges, rails);
  const double before = chords.cut_off(2) + chords.cut_off(4);
  fit_to_rails(row.mesh, chords, rails);
  EXPECT_LT(chords.cut_off(2) + chords.cut_off(4), before / 2);
  EXPECT_LT(farthest_spike(), 0.35f);
  EXPECT_EQ(row.mesh.positions[0], lower[0]);
  EXPECT_EQ(row.mesh.positions[5], lower[5]);
  for (Index k = 0; k + 1 < lower.size(); ++k) {
    EXPECT_LT(row.mesh.positions[k].x(), row.mesh.positions[k + 1].x());
  }
}

/// Holes no larger than a few faces: at a corner of the mesh on their rim, all but a quarter of the
/// way around it may belong to the surface, which one face alone cannot span.
TEST(Finish, RimsOfSmallHolesHaveSoundFaces) {
  const Mesh whole = sample_shape("blob");
  for (const float radius : {0.04f, 0.06f, 0.09f}) {
    Mesh shape;
    shape.positions = whole.positions;
    const auto in_a_hole = [&](Index v) {
      const Vec3 direction = whole.positions[v].normalized();
      const float farthest = direction.cwiseAbs().maxCoeff();
      return 2 - 2 * farthest < radius * radius;  // of the nearest axis
    };
    for (std::size_t f = 0; f < whole.faces.size(); ++f) {
      if (std::ranges::none_of(whole.faces[f], in_a_hole)) shape.faces.push_back(whole.faces[f]);
    }
    for (const std::size_t count : {2000, 3000, 4000, 5000, 9000}) {
      SCOPED_TRACE(count);
      const Mesh result = remeshed(shape, count);
      const MeshStatistics s = mesh_statistics(result);
      EXPECT_EQ(s.boundary_loops, 6u);
      EXPECT_GT(s.jacobian_min, 0.1);
      const auto wanted = static_cast<double>(count);
      EXPECT_NEAR(static_cast<double>(result.faces.size()), wanted, 0.01 * wanted);
    }
  }
}

/// Too many edges meet between the holes: no move gives all of the quads there room.
TEST(Finish, QuadsWithoutRoomAreTakenAway) {
  const Mesh shape = sample_shape("three-holes");
  const Mesh result = remeshed(shape, 500);
  const MeshStatistics s = mesh_statistics(result);
  EXPECT_GT(s.jacobian_min, 0.1);
  EXPECT_GE(s.faces, 495u);
  made::expect_same_topology(s, mesh_statistics(shape));
}

Index nearest(const Mesh& surface, const Vec3& p) {
  const auto nearer = [&](const Vec3& a, const Vec3& b) {
    return (a - p).squaredNorm() < (b - p).squaredNorm();
  };
  return static_cast<Index>(std::ranges::min_element(surface.positions, nearer) -
                            surface.positions.begin());
}

/// Vertices at the integers of a plane, the first coordinate first.
Extraction integer_grid(Index n, Index rows) {
  Extraction grid;
  for (Index y = 0; y < rows; ++y) {
    for (Index x = 0; x < n; ++x) {
      const Index v = y * n + x;
      grid.mesh.positions.push_back(Vec3(static_cast<float>(x), static_cast<float>(y), 0));
      grid.nodes.push_back(v);
      if (x > 0 && y > 0) grid.mesh.faces.push_back({v - n - 1, v - n, v, v - 1});
    }
  }
  return grid;
}

TEST(Finish, CornersOfTwistedQuadsMoveIfNothingElseCan) {
  constexpr Index n = 7, middle = n * n / 2;
  const std::vector<Vec3> normals(n * n, Vec3::UnitZ());
  Extraction grid = integer_grid(n, n);
  grid.mesh.positions[middle] += Vec3(1.2f, 0.1f, 0);
  grid.corners.resize(n * n);
  std::iota(grid.corners.begin(), grid.corners.end(), Index{0});
  const Extraction before = grid;
  ASSERT_GT(mesh_statistics(grid.mesh).inverted_quads, 0u);
  untwist(grid, normals, true, Context());
  EXPECT_EQ(mesh_statistics(grid.mesh).inverted_quads, 0u);
  for (Index v = 0; v < n * n; ++v) {
    const bool on_border = v < n || v >= n * (n - 1) || v % n == 0 || v % n == n - 1;
    if (on_border) {
      EXPECT_EQ(grid.mesh.positions[v], before.mesh.positions[v]) << v;
    }
  }
}

TEST(Finish, BordersOfTwistedQuadsMoveIfTheyNeedNotStay) {
  constexpr Index n = 12, middle = 5;
  const std::vector<Vec3> normals(2 * n, Vec3::UnitZ());
  Extraction strip = integer_grid(n, 2);
  strip.mesh.positions[middle] += Vec3(1.3f, 0, 0);  // over the next one along the border
  const Extraction before = strip;
  ASSERT_GT(mesh_statistics(strip.mesh).inverted_quads, 0u);
  untwist(strip, normals, true, Context());
  EXPECT_EQ(strip.mesh.positions, before.mesh.positions);
  untwist(strip, normals, false, Context());
  EXPECT_EQ(mesh_statistics(strip.mesh).inverted_quads, 0u);
}

TEST(Finish, WhatIsTurnedAroundInItselfComesUntwisted) {
  constexpr Index n = 13, half = n / 2, reach = 2;
  const std::vector<Vec3> normals(n * n, Vec3::UnitZ());
  Extraction grid = integer_grid(n, n);
  const Vec3 middle(half, half, 0);
  for (Vec3& p : grid.mesh.positions) {
    if ((p - middle).cwiseAbs().maxCoeff() <= reach) p = 2 * middle - p;  // by half a turn
  }
  ASSERT_GT(mesh_statistics(grid.mesh).inverted_quads, 8u);
  untwist(grid, normals, true, Context());
  EXPECT_EQ(mesh_statistics(grid.mesh).inverted_quads, 0u);
}

/// A few of these come untwisted only from where vertices lie amid their neighbours.
TEST(Finish, TangledVerticesComeUntwisted) {
  constexpr Index n = 17, half = n / 2, reach = 2;
  constexpr float farthest = 1.2f;  // on each axis
  const std::vector<Vec3> normals(n * n, Vec3::UnitZ());
  const Vec3 middle(half, half, 0);
  std::mt19937 random;
  const auto offset = [&] {
    return farthest * (2 * static_cast<float>(random()) / static_cast<float>(random.max()) - 1);
  };
  for (int time = 0; time < 100; ++time) {
    Extraction grid = integer_grid(n, n);
    for (Vec3& p : grid.mesh.positions) {
      if ((p - middle).cwiseAbs().maxCoeff() > reach) continue;
      for (float& coordinate : p) coordinate += offset();
    }
    ASSERT_GT(mesh_statistics(grid.mesh).inverted_quads, 0u) << time;
    untwist(grid, normals, true, Context());
    EXPECT_EQ(mesh_statistics(grid.mesh).inverted_quads, 0u) << time;
  }
}

/// A pleat: no corner of its faces is turned in, but those in the middle lie on their backs.
TEST(Finish, FacesTurnedOverAsAWholeComeUntwisted) {
  constexpr Index n = 9;
  Extraction grid = integer_grid(n, n);
  const std::vector<Vec3> normals(n * n, Vec3::UnitZ());
  for (Index y = 0; y < n; ++y) {
    constexpr float pleated[] = {0, 1.6f, 3.2f, 4.8f, 4.0f, 3.2f, 4.8f, 6.4f, 8};
    for (Index x = 0; x < n; ++x) grid.mesh.positions[y * n + x].x() = pleated[x];
  }
  const auto turned_over = [&] {
    const VertexFaces around = vertex_faces(grid.mesh);
    std::size_t count = 0;
    for (Index f = 0; f < grid.mesh.faces.size(); ++f) {
      count += is_turned_over(grid, f, around, normals);
    }
    return count;
  };
  ASSERT_EQ(mesh_statistics(grid.mesh).inverted_quads, 0u);
  ASSERT_GT(turned_over(), 0u);
  for (Index y = 0; y < n; y += n - 1) {  // the border is as it should be
    for (Index x = 0; x < n; ++x) grid.mesh.positions[y * n + x].x() = static_cast<float>(x);
  }
  untwist(grid, normals, true, Context());
  EXPECT_EQ(turned_over(), 0u);
  EXPECT_EQ(mesh_statistics(grid.mesh).inverted_quads, 0u);
}

/// Of a grid over a plane some vertices lie where they turn quads in; those of the border, or at a
/// corner, must stay there.
TEST(Finish, TwistedQuadsGoOffTheSurface) {
  constexpr Index n = 7;
  const auto at = [](Index x, Index y) { return y * n + x; };
  Extraction grid = integer_grid(n, n);
  const std::vector<Vec3> normals(n * n, Vec3::UnitZ());
  const Extraction regular = grid;
  untwist(grid, normals, true, Context());
  EXPECT_EQ(grid.mesh.positions, regular.mesh.positions);

  Extraction straight = grid;  // a corner at (3, 3) that rounding would turn in
  straight.mesh.positions[at(3, 3)] -= Vec3(0.499999f, 0.499999f, 0);
  ASSERT_NEAR(mesh_statistics(straight.mesh).jacobian_min, 0, 1e-5);
  untwist(straight, normals, true, Context());
  EXPECT_GT(mesh_statistics(straight.mesh).jacobian_min, 1e-3);

  grid.mesh.positions[at(3, 3)] += Vec3(1.1f, 0.2f, 0);
  grid.mesh.positions[at(2, 1)] += Vec3(-0.4f, 0.2f, 0.3f);
  grid.corners = {at(2, 1)};
  const Extraction before = grid;
  ASSERT_GT(mesh_statistics(grid.mesh).inverted_quads, 0u);
  untwist(grid, normals, true, Context());
  EXPECT_EQ(mesh_statistics(grid.mesh).inverted_quads, 0u);
  EXPECT_TRUE(find_crossings(grid.mesh, Context()).empty());
  EXPECT_EQ(grid.mesh.positions[at(2, 1)], before.mesh.positions[at(2, 1)]);
  for (Index y = 0; y < n; ++y) {
    for (Index x = 0; x < n; ++x) {
      const Vec3& p = grid.mesh.positions[at(x, y)];
      const bool on_border = x == 0 || y == 0 || x == n - 1 || y == n - 1;
      if (on_border) {
        EXPECT_EQ(p, regular.mesh.positions[at(x, y)]);
      }
      EXPECT_LT((p - before.mesh.positions[at(x, y)]).norm(), 2.0f);
    }
  }
}

/// A leg of five faces around: from its far side no step over the surface leads back.
TEST(Finish, VerticesComeBackFromTheOtherSide) {
  constexpr double radius = 0.3, top = 2;
  std::vector<std::array<double, 2>> profile;
  for (int k = -20; k <= 20; ++k) profile.push_back({radius, top * k / 20});
  const Mesh surface = triangulate(turned(profile, 60));
  const Graph graph = build_graph(surface);
  constexpr Index around_leg = 5, rings = 7, strayed = 3 * around_leg;
  Extraction leg;
  for (Index k = 0; k < around_leg * rings; ++k) {
    const double angle = 2 * std::numbers::pi * (k % around_leg) / around_leg;
    const double turned_angle = k == strayed ? angle + std::numbers::pi : angle;
    const double z = 0.35 * (static_cast<double>(k / around_leg) - (rings - 1) / 2.0);
    leg.mesh.positions.push_back(
        Eigen::Vector3d(radius * std::cos(turned_angle), radius * std::sin(turned_angle), z)
            .cast<float>());
    leg.nodes.push_back(nearest(surface, leg.mesh.positions.back()));
    if (k + around_leg >= around_leg * rings) continue;
    const Index next = k % around_leg + 1 < around_leg ? k + 1 : k + 1 - around_leg;
    leg.mesh.faces.push_back(std::array<Index, 4>{k, next, next + around_leg, k + around_leg});
  }
  const FeatureLines none;
  const VertexFaces around_surface = vertex_faces(surface);
  Placement placement(leg, surface, around_surface, graph, none);
  std::vector<Vec3> normals;
  for (Index v = 0; v < leg.nodes.size(); ++v) normals.push_back(placement.normal(v));
  const VertexFaces around = vertex_faces(leg.mesh);
  const std::vector<Index> folded(around[strayed].begin(), around[strayed].end());
  const std::vector<Index> moved = unfold(leg, around, placement, normals, folded);
  EXPECT_EQ(moved, std::vector<Index>{strayed});
  EXPECT_LT((leg.mesh.positions[strayed] - Vec3(static_cast<float>(radius), 0, 0)).norm(), 0.1);
  EXPECT_GT(normals[strayed].x(), 0.9f);
}

/// A triangle in a plate of four bare corners.
TEST(Finish, AVertexHoldsOnlyTheEndFarthestFromIt) {
  const Mesh plate = sample_shape("plate");
  Extraction triangle;
  triangle.mesh.positions = {Vec3(0.1f, 0, 0), Vec3(-0.1f, 0.1f, 0), Vec3(-0.1f, -0.1f, 0)};
  triangle.mesh.faces.push_back(std::array<Index, 3>{0, 1, 2});
  for (const Vec3& p : triangle.mesh.positions) triangle.nodes.push_back(nearest(plate, p));
  const std::vector<Reach> ends = find_bare_ends(triangle, vertex_faces(triangle.mesh),
                                                 build_graph(plate), EdgeLength(0.2f), Context());
  ASSERT_EQ(ends.size(), 3u);
  std::vector<Index> vertices;
  for (const Reach& end : ends) {
    vertices.push_back(end.vertex);
    EXPECT_FLOAT_EQ(end.tip.cwiseAbs().x(), 0.5f);
    EXPECT_FLOAT_EQ(end.tip.cwiseAbs().y(), 0.5f);
  }
  std::ranges::sort(vertices);
  EXPECT_EQ(vertices, (std::vector<Index>{0, 1, 2}));
}

TEST(Finish, BareNodesAreThoseFarFromVerticesAndFaces) {
  constexpr float reach = 0.2f;
  const Mesh plate = sample_shape("plate");
  Extraction triangle;
  triangle.mesh.positions = {Vec3(0.3f, 0, 0), Vec3(-0.3f, 0.3f, 0), Vec3(-0.3f, -0.3f, 0)};
  triangle.mesh.faces.push_back(std::array<Index, 3>{0, 1, 2});
  const auto& corners = triangle.mesh.positions;
  for (const Vec3& p : corners) triangle.nodes.push_back(nearest(plate, p));
  std::vector<Index> expected;
  std::size_t beside_face = 0;
  for (Index v = 0; v < plate.positions.size(); ++v) {
    const Vec3& p = plate.positions[v];
    if (std::ranges::any_of(corners, [&](const Vec3& q) { return (p - q).norm() <= reach; })) {
      continue;
    }
    const Vec3 q = closest_point_on_triangle(p, corners[0], corners[1], corners[2]);
    if ((p - q).norm() > 0.75f * reach) {
      expected.push_back(v);
    } else {
      ++beside_face;
    }
  }
  EXPECT_GT(expected.size(), 100u);
  EXPECT_GT(beside_face, 100u);
  EXPECT_EQ(find_bare_nodes(triangle, vertex_faces(triangle.mesh), build_graph(plate),
                            EdgeLength(reach), Context()),
            expected);
}

/// A ball with a horn about as thick as a face of the target is large.
TEST(Finish, HornsAreReached) {
  std::vector<std::array<double, 2>> profile;
  constexpr int steps = 80;
  constexpr double thin = 0.12, tip = 2.2;
  for (int k = 0; k <= steps; ++k) {
    const double angle = (std::numbers::pi - std::asin(thin)) * k / steps;
    profile.push_back({std::sin(angle), -std::cos(angle)});
  }
  const double base = profile.back()[1];
  for (int k = 1; k <= steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    profile.push_back({thin * (1 - 0.8 * share), base + (tip - base) * share});
  }
  profile.push_back({0, tip});
  const Mesh shape = turned(profile, 120);
  for (const std::size_t count : {500, 1000, 2000}) {
    const Mesh result = remeshed(shape, count);
    float highest = 0;
    for (const Vec3& p : result.positions) highest = std::max(highest, p.z());
    EXPECT_GT(highest, tip - 1.2 * mesh_statistics(result).edge_mean) << count << " faces";
  }
}

/// A round stem, the lower half, that becomes a flat paddle. Half axes.
Mesh paddle(double stem, double width, double thickness) {
  constexpr int steps = 160;
  constexpr double length = 2.2, foot = 0.06, tip = 0.2;  // shares: where the ends are round
  const auto rounded = [](double x) { return std::sqrt(std::max(0.0, 1 - x * x)); };
  std::vector<std::array<double, 2>> profile;
  for (int k = 0; k <= steps; ++k) {
    const double t = static_cast<double>(k) / steps;
    profile.push_back(
        {rounded(std::max(0.0, t - (1 - tip)) / tip) * rounded(std::max(0.0, foot - t) / foot),
         length * t});
  }
  Mesh mesh = turned(profile, 64);
  for (Vec3& p : mesh.positions) {
    const double x = std::clamp((p.z() / length - 0.45) / 0.2, 0.0, 1.0);
    const double share = x * x * (3 - 2 * x);
    p.x() *= static_cast<float>(stem + share * (width - stem));
    p.y() *= static_cast<float>(stem + share * (thickness - stem));
  }
  return mesh;
}

/// Rows of faces must begin where the stem becomes wide.
TEST(Finish, PaddlesAreFilled) {
  double distance = 0;  // to the result, in sides
  int results = 0;
  for (const auto& [stem, width, thickness] :
       {std::array{0.06, 0.35, 0.06}, {0.08, 0.4, 0.08}, {0.1, 0.4, 0.06}}) {
    const Mesh shape = paddle(stem, width, thickness);
    for (const std::size_t count : {200, 300, 400}) {
      const Mesh result = remeshed(shape, count);
      made::expect_same_topology(mesh_statistics(result), mesh_statistics(shape));
      distance += surface_distance(shape, result, mesh_statistics(result).edge_mean, 20000).mean;
      ++results;
    }
  }
  EXPECT_LT(distance / results, 0.09);  // 0.11 where singularities are cancelled as usual
}

/// A square sheet of `n` quads a side from -1 to 1, of height(x).
template <typename Height>
Mesh sheet(Index n, const Height& height) {
  Mesh mesh;
  for (Index j = 0; j <= n; ++j) {
    for (Index i = 0; i <= n; ++i) {
      const float x = 2 * static_cast<float>(i) / static_cast<float>(n) - 1;
      mesh.positions.emplace_back(x, 2 * static_cast<float>(j) / static_cast<float>(n) - 1,
                                  height(x));
    }
  }
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      const Index a = j * (n + 1) + i, b = a + 1;
      mesh.faces.push_back(std::array<Index, 4>{a, b, b + n + 1, a + n + 1});
    }
  }
  return mesh;
}

/// A rounded roof, whose ridge lies a third of a face beside a row of vertices.
TEST(Finish, VerticesGoToRidges) {
  constexpr Index coarse = 12;
  constexpr float ridge = 1.0f / (3 * coarse / 2);
  const auto roof = [](float x) { return -std::sqrt((x - ridge) * (x - ridge) + 0.0004f); };
  const Mesh surface = triangulate(sheet(144, roof));
  const Graph graph = build_graph(surface);
  const Mesh even = sheet(coarse, roof);
  Extraction extraction{even, {}, {}, {}};
  for (const Vec3& p : even.positions) extraction.nodes.push_back(nearest(surface, p));
  const VertexFaces around_surface = vertex_faces(surface);
  const VertexFaces around = vertex_faces(even);
  const FeatureLines none;
  Placement placement(extraction, surface, around_surface, graph, none);
  const double before = surface_distance(even, surface, 1, 20000).mean;
  fit_to_surface(extraction, around, placement, 1, Context());
  EXPECT_LT(surface_distance(extraction.mesh, surface, 1, 20000).mean, 0.6 * before);
  // The row beside the ridge came nearer to it, and flat parts stayed as they are.
  for (Index j = 1; j < coarse; ++j) {
    const auto place = [&](const Mesh& mesh, Index i) {
      return mesh.positions[j * (coarse + 1) + i];
    };
    EXPECT_LT(std::abs(place(extraction.mesh, coarse / 2).x() - ridge), 0.7f * ridge);
    const Vec3 moved = place(extraction.mesh, 2) - place(even, 2);
    EXPECT_LT(moved.norm(), 0.02f / coarse);
  }
}

/// Where faces were the nodes of the graph, vertices are finished over the vertices all the same.
TEST(Smooth, ReachesTheTipsOfASpindleOverAGraphOfFaces) {
  Mesh spindle = sample_shape("sphere");
  for (Vec3& p : spindle.positions) p = p.cwiseProduct(Vec3(1, 0.1f, 0.1f));
  RemeshOptions options;
  options.face_count = 300;
  options.graph.nodes = GraphNodes::faces;
  const Mesh result = remesh(spindle, options).mesh;
  const MeshStatistics s = mesh_statistics(result);
  EXPECT_EQ(s.inverted_quads, 0u);
  EXPECT_LT(surface_distance(spindle, result, s.edge_mean).max, 1.5);
}

}  // namespace
}  // namespace meshgrain
