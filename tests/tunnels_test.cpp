#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "made_volume.h"
#include "meshgrain/remesh.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "same_topology.h"
#include "tunnels/close_tunnels.h"
#include "util/edge_of.h"

namespace meshgrain {
namespace {

using Point = Eigen::Vector3d;

constexpr double half_thickness = 0.1, hole_radius = 0.09, hole_spacing = 0.5;

double plate_without_holes(const Point& p) {
  const Point q = p.cwiseAbs() - Point(0.85, 0.85, half_thickness);
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

/// With three by three of them.
double plate(const Point& p) {
  const auto nearest = [](double x) {
    return x - hole_spacing * std::clamp(std::round(x / hole_spacing), -1.0, 1.0);
  };
  const double holes = hole_radius - std::hypot(nearest(p.x()), nearest(p.y()));
  return std::max(plate_without_holes(p), holes);
}
constexpr std::size_t plate_holes = 9;

/// A ring, of which a tube is bent around.
double ring(const Point& p, const Point& center, double radius, double tube) {
  const Point q = p - center;
  return std::hypot(std::hypot(q.x(), q.z()) - radius, q.y()) - tube;
}

/// A ball with an ear, upright on top.
double ball_with_ear(const Point& p, double radius, double tube) {
  const Point top(0, 0, 0.5);
  return std::min(p.norm() - 0.5, ring(p, top, radius, tube));
}

std::vector<Index> all_vertices(const Mesh& mesh) {
  std::vector<Index> all(mesh.positions.size());
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

/// Closes all tunnels with loops up to a length; what is left must be one closed manifold.
std::size_t closed_in(Mesh& mesh, double longest) {
  const long before = mesh_statistics(mesh).euler;
  const std::size_t count = close_tunnels(mesh, all_vertices(mesh), longest, Context());
  const MeshStatistics after = mesh_statistics(mesh);
  EXPECT_EQ(after.euler, before + 2 * static_cast<long>(count));
  EXPECT_EQ(after.components, 1u);
  EXPECT_EQ(after.boundary_loops + after.non_manifold_edges + after.non_manifold_vertices, 0u);
  EXPECT_EQ(after.isolated_vertices, 0u);
  return count;
}

double volume_of(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto c = mesh.faces[f];
    const Vec3 &a = mesh.positions[c[0]], &b = mesh.positions[c[1]], &d = mesh.positions[c[2]];
    sum += a.cross(b).dot(d) / 6;
  }
  return sum;
}

TEST(Tunnels, HolesAreClosedFlushWithThePlate) {
  Mesh mesh = made::sampled_on_grid(plate, 40);
  const double before = volume_of(mesh);
  ASSERT_EQ(mesh_statistics(mesh).euler, 2 - 2 * static_cast<long>(plate_holes));
  EXPECT_EQ(closed_in(mesh, 1.2 * 2 * M_PI * hole_radius), plate_holes);
  const double holes = volume_of(made::sampled_on_grid(plate_without_holes, 40)) - before;
  const double filled = volume_of(mesh) - before;
  EXPECT_GE(filled, 0.8 * holes);  // where it does not show how far one goes, lids are inside
  EXPECT_LE(filled, 1.02 * holes);
}

TEST(Tunnels, WiderOnesStay) {
  Mesh mesh = made::sampled_on_grid(plate, 40);
  const Mesh before = mesh;
  EXPECT_EQ(closed_in(mesh, 0.7 * 2 * M_PI * hole_radius), 0u);
  EXPECT_EQ(mesh.positions, before.positions);
}

/// Those that are as wide as some near to the given vertices, wherever they are, if they are no
/// more than these.
TEST(Tunnels, OthersAlikeAreClosedWhereMostAre) {
  const Mesh mesh = made::sampled_on_grid(plate, 40);
  constexpr double longest = 1.3 * 2 * M_PI * hole_radius;
  const auto closed_near = [&](const auto& is_near) {
    std::vector<Index> near;
    for (Index v = 0; v < mesh.positions.size(); ++v) {
      if (is_near(mesh.positions[v])) near.push_back(v);
    }
    Mesh result = mesh;
    return close_tunnels(result, near, longest, Context());
  };
  EXPECT_EQ(closed_near([](const Vec3& p) { return p.x() > -0.2f; }), plate_holes);
  const std::size_t few = closed_near([](const Vec3& p) { return p.x() > 0.5f; });
  EXPECT_GE(few, 2u);
  EXPECT_LE(few, plate_holes / 2);
}

TEST(Tunnels, SmallHandlesGoAndLargeOnesStay) {
  const auto with_ear = [](double radius, double tube) {
    return made::sampled_on_grid([=](const Point& p) { return ball_with_ear(p, radius, tube); },
                                 60);
  };
  Mesh small = with_ear(0.15, 0.05);
  ASSERT_EQ(mesh_statistics(small).euler, 0);
  EXPECT_EQ(closed_in(small, 0.8), 1u);
  // Its cross-section is no longer around, but what it goes around is.
  Mesh large = with_ear(0.35, 0.05);
  ASSERT_EQ(mesh_statistics(large).euler, 0);
  EXPECT_EQ(closed_in(large, 0.8), 0u);
}

/// The solid is where the volume is, whichever side the faces look to.
TEST(Tunnels, SidesMayBeInsideOut) {
  const auto turned = [](Mesh mesh) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) std::ranges::reverse(mesh.faces[f]);
    return mesh;
  };
  Mesh holes = turned(made::sampled_on_grid(plate, 40));
  EXPECT_EQ(closed_in(holes, 1.2 * 2 * M_PI * hole_radius), plate_holes);
  Mesh ear = turned(
      made::sampled_on_grid([](const Point& p) { return ball_with_ear(p, 0.35, 0.05); }, 60));
  EXPECT_EQ(closed_in(ear, 0.8), 0u);
}

/// Lids would cut through a pin in a hole.
TEST(Tunnels, WhatOthersGoThroughStaysOpen) {
  Mesh mesh = made::sampled_on_grid(plate, 40);
  const auto pin = [](const Point& p) {
    return std::max(std::hypot(p.x(), p.y()) - 0.4 * hole_radius, std::abs(p.z()) - 0.5);
  };
  const auto first = static_cast<Index>(mesh.positions.size());
  const Mesh added = made::sampled_on_grid(pin, 80);
  mesh.positions.insert(mesh.positions.end(), added.positions.begin(), added.positions.end());
  for (std::size_t f = 0; f < added.faces.size(); ++f) {
    const auto c = added.faces[f];
    mesh.faces.push_back({c[0] + first, c[1] + first, c[2] + first});
  }
  const double longest = 1.2 * 2 * M_PI * hole_radius;
  EXPECT_EQ(close_tunnels(mesh, all_vertices(mesh), longest, Context()), plate_holes - 1);
}

TEST(Tunnels, LimbsAreNotCutOff) {
  const auto limbs = [](const Point& p) {
    const double across = std::hypot(p.y(), p.z());
    const double bar = std::max(across - 0.08, std::abs(p.x()) - 0.8);
    const double knobs = (Point(std::abs(p.x()), p.y(), p.z()) - Point(0.6, 0, 0)).norm() - 0.3;
    return std::min(bar, knobs);
  };
  Mesh mesh = made::sampled_on_grid(limbs, 50);
  EXPECT_EQ(closed_in(mesh, 1.0), 0u);
}

TEST(Tunnels, MarksGoWithTheirEdges) {
  Mesh mesh = made::sampled_on_grid(plate, 40);
  const auto is_in_a_hole = [&](Index v) {
    const Vec3& p = mesh.positions[v];
    return std::abs(p.z()) < 0.5 * half_thickness && std::abs(p.x()) < 0.75 &&
           std::abs(p.y()) < 0.75;
  };
  std::size_t in_holes = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto c = std::as_const(mesh.faces)[f];
    mesh.marked_edges.push_back({c[0], c[1]});
    in_holes += is_in_a_hole(c[0]) && is_in_a_hole(c[1]);
  }
  ASSERT_GT(in_holes, 100u);
  const std::size_t before = mesh.marked_edges.size();
  closed_in(mesh, 1.2 * 2 * M_PI * hole_radius);
  EXPECT_LE(mesh.marked_edges.size(), before - in_holes);
  const std::size_t count = mesh.marked_edges.size();
  EXPECT_GT(count, before / 2);
  std::vector<std::array<Index, 2>> edges;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto c = std::as_const(mesh.faces)[f];
    for (std::size_t k = 0; k < 3; ++k) {
      edges.push_back(edge_of(c[k], c[(k + 1) % 3]));
    }
  }
  std::ranges::sort(edges);
  for (const auto& [a, b] : mesh.marked_edges) {
    ASSERT_TRUE(std::ranges::binary_search(edges, edge_of(a, b)));
  }
}

/// With faces about as large as the holes there is no room for faces around them.
TEST(Tunnels, FacesAreValidWhereHolesWouldSpoilThem) {
  const Mesh input = made::sampled_on_grid(plate, 40);
  RemeshOptions options;
  options.features.creases = Creases::none;
  options.face_count = 150;
  const RemeshResult coarse = remesh(input, options);
  const MeshStatistics s = mesh_statistics(coarse.mesh);
  EXPECT_EQ(s.inverted_quads, 0u);
  EXPECT_EQ(s.non_manifold_edges + s.non_manifold_vertices + s.boundary_loops, 0u);
  EXPECT_EQ(s.components, 1u);
  EXPECT_EQ(s.euler, 2);
  EXPECT_NEAR(static_cast<double>(s.faces), 150, 1.5);
  ASSERT_FALSE(coarse.report.notes.empty());
  EXPECT_EQ(coarse.report.notes.back(),
            "closed 9 tunnels: faces of this size around them would be inverted or pass through "
            "each other");
  EXPECT_EQ(coarse.report.input_vertices, input.positions.size());
  options.face_count = 3000;  // room enough
  const RemeshResult fine = remesh(input, options);
  made::expect_same_topology(mesh_statistics(fine.mesh), mesh_statistics(input));
  EXPECT_EQ(mesh_statistics(fine.mesh).inverted_quads, 0u);
  EXPECT_TRUE(fine.report.notes.empty());
}

}  // namespace
}  // namespace meshgrain
