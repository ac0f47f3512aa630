#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "kept_creases.h"
#include "made_volume.h"
#include "measure/crossings.h"
#include "mesh/border.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "same_topology.h"
#include "sharpen/sharpen.h"
#include "sharpen/sharpen_chamfers.h"

namespace meshgrain {
namespace {

using Point = Eigen::Vector3d;

const Eigen::Matrix3d askew =
    Eigen::AngleAxisd(0.5, Point(0.3, 1, 0.4).normalized()).toRotationMatrix();

double box(const Point& p, const Point& half) {
  const Point q = p.cwiseAbs() - half;
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

double cylinder(const Point& p, double radius, double half_height) {
  const Point q(std::hypot(p.x(), p.y()) - radius, std::abs(p.z()) - half_height, 0);
  return q.cwiseMax(0).norm() + std::min(q.head<2>().maxCoeff(), 0.0);
}

Mesh turned(Mesh mesh, const Eigen::Matrix3d& by) {
  for (Vec3& p : mesh.positions) p = by.cast<float>() * p;
  return mesh;
}

Mesh sampled_cube(int cells, const Eigen::Matrix3d& by = askew) {
  const auto cube = [&](const Point& p) { return box(by.transpose() * p, Point::Constant(0.5)); };
  return made::sampled_on_grid(cube, cells);
}

TEST(Chamfers, PartsSampledOnAGridGetTheirCreasesBack) {
  const auto can = [](const Point& p) {
    const Point q = askew.transpose() * p;
    return cylinder({q.x(), q.z(), q.y()}, 0.5, 0.5);
  };
  const std::pair<const char*, Mesh> sampled[] = {{"cube", sampled_cube(40)},
                                                  {"cylinder", made::sampled_on_grid(can, 40)}};
  for (const auto& [name, mesh] : sampled) {
    SCOPED_TRACE(name);
    const Mesh part = turned(sample_shape(name, 3), askew);
    RemeshOptions options;
    options.face_count = 600;
    const RemeshResult result = remesh(mesh, options);
    made::expect_same_topology(mesh_statistics(result.mesh), mesh_statistics(part));
    const made::Kept kept = made::kept_creases(part, result.mesh);
    EXPECT_GE(kept.creases, 0.97);
    EXPECT_GE(kept.corners, 0.85);  // one was put back, so that faces do not cross
    EXPECT_EQ(result.report.notes.size(), 1u);
    options.features.creases = Creases::none;
    const RemeshResult without = remesh(mesh, options);
    EXPECT_LE(made::kept_creases(part, without.mesh).creases, 0.3);
    EXPECT_TRUE(without.report.notes.empty());
  }
}

/// Concave edges, and corners at which they meet others.
TEST(Chamfers, SurfacesMeetWhereThePartHasItsEdges) {
  constexpr int cells = 48;
  const auto bracket = [](const Point& p) {
    const Point q = askew.transpose() * p;
    const double both = std::min(box(q + Point(0, 0.4, 0), Point(0.6, 0.15, 0.4)),
                                 box(q + Point(0.45, 0, 0), Point(0.15, 0.55, 0.4)));
    const Point through(q.x() - 0.2, q.z(), q.y());
    return std::max(both, -cylinder(through, 0.2, 1));
  };
  Mesh surface = made::sampled_on_grid(bracket, cells);
  ASSERT_EQ(sharpen(surface, 0.05, Context()), Blur::chamfers);
  double off = 0;
  for (const auto& [a, b] : surface.marked_edges) {
    const Vec3 middle = (surface.positions[a] + surface.positions[b]) / 2;
    off += std::abs(bracket(middle.cast<double>()));
  }
  const auto count = static_cast<double>(surface.marked_edges.size());
  EXPECT_GE(count, 500);
  EXPECT_LE(off / count, 0.04 * 2.0 / cells);
}

/// Of each vertex, how many marked edges end there.
std::vector<int> marks_at(const Mesh& mesh) {
  std::vector<int> count(mesh.positions.size(), 0);
  for (const auto& edge : mesh.marked_edges) {
    for (const Index v : edge) ++count[v];
  }
  return count;
}

/// Where a concave crease comes out between two others, more of the surface is in the way than at
/// other corners.
TEST(Chamfers, ConcaveCreasesEndInCorners) {
  constexpr int cells = 48;
  // Of a T: its bar, and its stem on it.
  const Point bar(0.71, 0.61, 0.2), stem(0.21, 0.61, 0.5);
  std::vector<Point> corners;
  for (const double x : {-bar.x(), -stem.x(), stem.x(), bar.x()}) {
    const bool is_of_stem = std::abs(x) < bar.x();
    for (const double y : {-bar.y(), bar.y()}) {
      for (const double z : {is_of_stem ? 0.8 : -0.2, 0.2}) corners.emplace_back(x, y, z);
    }
  }
  for (const Eigen::Matrix3d& by : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), askew}) {
    const auto part = [&](const Point& p) {
      const Point q = by.transpose() * p + Point(0, 0, 0.3);
      return std::min(box(q, bar), box(q - Point(0, 0, 0.3), stem));
    };
    Mesh surface = made::sampled_on_grid(part, cells);
    ASSERT_EQ(sharpen(surface, 0.05, Context()), Blur::chamfers);
    const std::vector<int> creases = marks_at(surface);
    std::size_t found = 0;
    for (const Point& corner : corners) {
      const Point place = by * (corner - Point(0, 0, 0.3));
      for (Index v = 0; v < creases.size(); ++v) {
        const double off = (surface.positions[v].cast<double>() - place).norm();
        found += creases[v] == 3 && off < 0.2 * 2.0 / cells;
      }
    }
    EXPECT_GE(found, by.isIdentity() ? 16u : 14u);
  }
}

/// A handle of a few cells is not smooth, wherever one looks.
TEST(Chamfers, PartsWithThinHandlesGetTheirCreasesBackToo) {
  constexpr int cells = 100;
  const auto mug = [](const Point& p) {
    const Point q = askew.transpose() * p;
    const double wall = std::max(cylinder(q, 0.6, 0.7), -cylinder(q - Point(0, 0, 0.3), 0.46, 0.8));
    const double ring = std::hypot(std::hypot(q.x() - 0.6, q.z()) - 0.3, q.y()) - 0.09;
    return std::min(wall, std::max(ring, 0.5 - std::hypot(q.x(), q.y())));
  };
  Mesh surface = made::sampled_on_grid(mug, cells);
  ASSERT_EQ(sharpen(surface, 0.05, Context()), Blur::chamfers);
  double around = 0;
  for (const auto& [a, b] : surface.marked_edges) {
    const Vec3 p = surface.positions[a], q = surface.positions[b];
    const double z = (askew.transpose() * p.cast<double>()).z();
    if (std::abs(z - 0.7) < 0.02) around += (q - p).norm();
  }
  EXPECT_NEAR(around / (2 * std::numbers::pi * (0.6 + 0.46)), 1, 0.02);
}

/// Chamfers of cells that are full or empty have sharp edges on both sides.
TEST(Chamfers, PartsOfCellsGetTheirCreasesBack) {
  constexpr int cells = 40;
  const auto bracket = [](const Point& p) {
    const double both = std::min(box(p - Point(0, 0, -0.5), Point(0.7, 0.7, 0.25)),
                                 box(p - Point(-0.45, 0, 0), Point(0.25, 0.7, 0.75)));
    return both < 0 ? -1.0 : 1.0;
  };
  const Mesh surface = made::sampled_on_grid(bracket, cells);
  Mesh sharp = surface;
  ASSERT_EQ(sharpen(sharp, 0.05, Context()), Blur::chamfers);
  const std::vector<int> creases = marks_at(sharp);
  EXPECT_EQ(std::ranges::count(creases, 3), 12);
  EXPECT_EQ(std::ranges::count(creases, 1), 0);
  RemeshOptions options;
  options.face_count = 1500;
  const MeshStatistics result = mesh_statistics(remesh(surface, options).mesh);
  EXPECT_LE(result.singularities, 30u);
  EXPECT_GE(result.jacobian_p01, 0.75);
}

TEST(Chamfers, AllElseStaysAsItIs) {
  constexpr int cells = 40;
  const auto ball = [](const Point& p) { return p.norm() - 0.7; };
  const auto rounded = [&](const Point& p) {  // by four cells
    constexpr double by = 4 * 2.0 / cells;
    return box(askew.transpose() * p, Point::Constant(0.6 - by)) - by;
  };
  const auto waves = [](const Point& p) {
    return p.norm() - 0.6 - 0.1 * std::sin(9 * p.x()) * std::sin(9 * p.y()) * std::sin(9 * p.z());
  };
  const auto voxels = [](const Point& p) { return p.norm() < 0.7 ? -1.0 : 1.0; };
  for (const made::Volume& volume :
       {made::Volume(ball), made::Volume(rounded), made::Volume(waves), made::Volume(voxels)}) {
    const Mesh before = made::sampled_on_grid(volume, cells);
    Mesh after = before;
    EXPECT_EQ(sharpen(after, 0.05, Context()), Blur::none);
    EXPECT_EQ(after.positions, before.positions);
    EXPECT_TRUE(after.marked_edges.empty());
  }
  for (const char* name : {"cube", "bracket", "shaft", "fused-boxes", "cylinder"}) {
    Mesh part = sample_shape(name);
    EXPECT_EQ(sharpen(part, 0.05, Context()), Blur::none) << name;
  }
}

/// A ring whose edges are rounded by three faces each, as CAD models have them: among the few large
/// faces of its sides, most of its vertices are there.
TEST(Chamfers, RoundedEdgesOfModelsStayAsTheyAre) {
  constexpr std::size_t around = 160;
  constexpr int faces = 3;
  constexpr float middle = 0.75f, half_width = 0.25f, half_height = 0.2f, radius = 0.03f;
  constexpr float quarter = std::numbers::pi_v<float> / 2;
  std::vector<std::array<float, 2>> profile;
  for (int corner = 0; corner < 4; ++corner) {
    const float right = corner == 0 || corner == 3 ? 1 : -1, up = corner < 2 ? 1 : -1;
    for (int k = 0; k <= faces; ++k) {
      const float angle = quarter * (static_cast<float>(corner) + static_cast<float>(k) / faces);
      profile.push_back({middle + right * (half_width - radius) + radius * std::cos(angle),
                         up * (half_height - radius) + radius * std::sin(angle)});
    }
    for (int k = -1; k <= 1; ++k) {
      const float along = 0.5f * static_cast<float>(k);
      profile.push_back(corner % 2 == 0
                            ? std::array{middle - right * along * half_width, up * half_height}
                            : std::array{middle + right * half_width, -up * along * half_height});
    }
  }
  Mesh ring;
  for (const auto& [r, z] : profile) {
    for (std::size_t k = 0; k < around; ++k) {
      const float angle = 4 * quarter * static_cast<float>(k) / around;
      ring.positions.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
  }
  const auto at = [&](std::size_t i, std::size_t k) {
    return static_cast<Index>(i % profile.size() * around + k % around);
  };
  for (std::size_t i = 0; i < profile.size(); ++i) {
    for (std::size_t k = 0; k < around; ++k) {
      ring.faces.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      ring.faces.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
  }
  Mesh after = ring;
  EXPECT_EQ(sharpen(after, 0.05, Context()), Blur::none);
  EXPECT_EQ(after.positions, ring.positions);
}

/// A column that hardly touches a wall: in the gap beside that they are nearer to each other than
/// the sides of a cell.
TEST(Chamfers, SurfacesDoNotPassThroughEachOther) {
  constexpr int cells = 40;
  const auto column_at_wall = [](const Point& p) {
    const Point q = askew.transpose() * p;
    constexpr double deep = 0.5 * 2.0 / cells;
    return std::min(box(q + Point(0.2, 0, 0), Point(0.3, 0.5, 0.4)),
                    cylinder(q - Point(0.3 - deep, 0, 0), 0.2, 0.35));
  };
  Mesh surface = made::sampled_on_grid(column_at_wall, cells);
  ASSERT_FALSE(sharpen_chamfers(surface, 0.05, Chamfered::yes, Context()).empty());
  const double edge = edge_lengths(surface).mean;
  for (const auto& [f, g] : find_crossings(surface, Context())) {
    EXPECT_LE(penetration(surface, f, g), 0.06 * edge);
  }
}

/// The places of its edges.
std::set<std::array<std::array<float, 3>, 2>> border_of(const Mesh& mesh) {
  std::set<std::array<std::array<float, 3>, 2>> result;
  for (const auto& [a, b] : border_edges(mesh)) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b];
    result.insert({std::array{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z()}});
  }
  return result;
}

/// Of a bar that reaches out of the grid at both ends: its edges end there.
TEST(Chamfers, BordersStayAsTheyAre) {
  const auto bar = [](const Point& p) { return box(askew.transpose() * p, {0.4, 0.3, 3}); };
  const Mesh before = made::sampled_on_grid(bar, 60);
  Mesh after = before;
  ASSERT_EQ(sharpen(after, 0.05, Context()), Blur::chamfers);
  EXPECT_EQ(border_of(after), border_of(before));
  RemeshOptions options;
  options.face_count = 1000;
  options.lock_borders = true;
  EXPECT_EQ(border_of(remesh(before, options).mesh), border_of(before));
}

TEST(Chamfers, DoNotDependOnThreads) {
  Mesh one = sampled_cube(30), three = one;
  ASSERT_EQ(sharpen(one, 0.05, Context(1)), Blur::chamfers);
  ASSERT_EQ(sharpen(three, 0.05, Context(3)), Blur::chamfers);
  EXPECT_EQ(one.positions, three.positions);
  EXPECT_EQ(one.marked_edges, three.marked_edges);
}

}  // namespace
}  // namespace meshgrain
