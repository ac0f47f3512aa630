#include <gtest/gtest.h>

#include <map>

#include "made_fields.h"
#include "made_points.h"
#include "meshgrain/alignment.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/surface.h"

namespace meshgrain {
namespace {

/// Vertices in the middle of creases (edges between faces more than 30 degrees apart), with the
/// crease's direction there. Vertices where creases end, meet or turn are left out.
struct Creases {
  std::vector<std::pair<Index, Vec3>> vertices;
  std::vector<std::array<Index, 2>> edges;
};

Creases find_creases(const Mesh& mesh) {
  std::map<std::pair<Index, Index>, std::vector<Vec3>> normals;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    const Vec3 &a = mesh.positions[face[0]], &b = mesh.positions[face[1]],
               &c = mesh.positions[face[2]];
    const Vec3 n = (b - a).cross(c - a).normalized();
    for (std::size_t k = 0; k < 3; ++k)
      normals[std::minmax(face[k], face[(k + 1) % 3])].push_back(n);
  }
  Creases creases;
  std::map<Index, std::vector<Vec3>> along;
  for (const auto& [edge, n] : normals) {
    if (n.size() != 2 || n[0].dot(n[1]) > 0.866f) continue;
    creases.edges.push_back({edge.first, edge.second});
    const Vec3 d = (mesh.positions[edge.second] - mesh.positions[edge.first]).normalized();
    along[edge.first].push_back(d);
    along[edge.second].push_back(d);
  }
  for (const auto& [vertex, d] : along) {
    if (d.size() == 2 && std::abs(d[0].dot(d[1])) > 0.95f) {
      creases.vertices.emplace_back(vertex, d[0]);
    }
  }
  return creases;
}

struct Snapping {
  double angle = 0;   // mean angle between crosses and creases, in degrees: 22.5 by chance
  double offset = 0;  // mean distance of creases from the lattice's lines, in edge lengths: 0.25
};

Snapping snapping(const Mesh& mesh, OrientationEnergy orientation_energy, PositionEnergy energy,
                  std::uint64_t seed) {
  const Creases creases = find_creases(mesh);
  const Hierarchy hierarchy = build_hierarchy(build_graph(mesh));  // no crease normals
  const float rho = 3.3f * static_cast<float>(edge_lengths(mesh).mean);
  OrientationOptions orientation;
  PositionOptions position;
  orientation.energy = orientation_energy;
  position.energy = energy;
  orientation.seed = position.seed = seed;
  const OrientationField crosses = solve_orientation(hierarchy, orientation);
  const PositionField lattices = solve_position(hierarchy, crosses, rho, position);
  Snapping result;
  const auto count = static_cast<double>(creases.vertices.size());
  EXPECT_GT(count, 100);
  for (const auto& [v, along] : creases.vertices) {
    const Vec3& o = crosses.directions[v];
    const Vec3 side = hierarchy.levels[0].normals[v].cross(o);
    const float c = std::abs(o.dot(along)), s = std::abs(side.dot(along));
    result.angle += std::atan2(std::min(c, s), std::max(c, s)) * 180 / std::numbers::pi / count;
    // Across the lattice's axis that runs along the crease.
    const Vec3& across = c > s ? side : o;
    result.offset += std::abs(across.dot(lattices.points[v] - mesh.positions[v])) / rho / count;
  }
  return result;
}

/// Figures 5 and 7: extrinsic energies alone snap orientations and lattice lines to creases.
TEST(Snapping, ExtrinsicFieldsFollowTheCreases) {
  const Mesh mesh = sample_shape("bracket", 0.7);
  for (const std::uint64_t seed : {0, 1, 2}) {
    const Snapping extrinsic =
        snapping(mesh, OrientationEnergy::extrinsic, PositionEnergy::extrinsic, seed);
    const Snapping intrinsic =
        snapping(mesh, OrientationEnergy::intrinsic, PositionEnergy::intrinsic, seed);
    const Snapping positions =
        snapping(mesh, OrientationEnergy::extrinsic, PositionEnergy::intrinsic, seed);
    // Measured 2.9 and 18 to 32 degrees, 0.02 and 0.23 to 0.29 edge lengths.
    EXPECT_LT(extrinsic.angle, 4);
    EXPECT_GT(intrinsic.angle, 4 * extrinsic.angle);
    EXPECT_LT(extrinsic.offset, 0.05);
    // With the same orientations, so that positions alone make the difference.
    EXPECT_GT(positions.offset, 4 * extrinsic.offset);
    EXPECT_GT(intrinsic.offset, 4 * extrinsic.offset);
  }
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const float t = std::clamp(d.dot(p - a) / d.squaredNorm(), 0.0f, 1.0f);
  return (p - a - t * d).norm();
}

/// And the edges of the mesh that is written lie on the creases.
TEST(Snapping, ExtrinsicEdgesLieOnTheCreases) {
  const Mesh mesh = sample_shape("bracket", 0.7);
  const Creases creases = find_creases(mesh);
  const auto distance = [&](OrientationEnergy orientation, PositionEnergy position) {
    RemeshOptions options;
    options.faces = OutputFaces::quad_dominant;
    options.edge_length = 3.3 * edge_lengths(mesh).mean;
    options.regularity = 0;  // as close to the fields as it gets
    options.features.creases = meshgrain::Creases::none;
    options.smoothing = 0;
    options.orientation_energy = orientation;
    options.position_energy = position;
    const Mesh result = remesh(mesh, options).mesh;
    double sum = 0;
    for (const auto& [v, along] : creases.vertices) {
      double nearest = 1e9;
      for (std::size_t f = 0; f < result.faces.size(); ++f) {
        const auto face = result.faces[f];
        for (std::size_t k = 0; k < face.size(); ++k) {
          nearest =
              std::min(nearest, distance_to_segment(mesh.positions[v], result.positions[face[k]],
                                                    result.positions[face[(k + 1) % face.size()]]));
        }
      }
      sum += nearest / options.edge_length;
    }
    return sum / static_cast<double>(creases.vertices.size());
  };
  const double extrinsic = distance(OrientationEnergy::extrinsic, PositionEnergy::extrinsic);
  const double intrinsic = distance(OrientationEnergy::intrinsic, PositionEnergy::intrinsic);
  // Measured 0.15 and 0.29 edge lengths.
  EXPECT_LT(extrinsic, 0.18);
  EXPECT_GT(intrinsic, 1.6 * extrinsic);
}

/// A tube has a principal direction along its axis everywhere; the intrinsic energy does not care.
TEST(CurvatureAlignment, TurnsTheFieldOfATubeAlongIt) {
  const Mesh tube = made::grid(60, 40, true, false, [](double u, double v) -> Vec3 {
    const double a = 2 * std::numbers::pi * u;
    return Eigen::Vector3d(std::cos(a), std::sin(a), 3 * v).cast<float>();
  });
  const Hierarchy hierarchy = build_hierarchy(build_graph(tube));
  const auto mean_angle = [&](const CurvatureAlignment& alignment, std::uint64_t seed) {
    OrientationOptions options;
    options.energy = OrientationEnergy::intrinsic;
    options.seed = seed;
    const auto constraints = curvature_constraints(hierarchy.levels[0], 0.4f, alignment);
    const auto field = solve_orientation(hierarchy, options, constraints);
    double sum = 0;
    for (const Vec3& d : field.directions) {
      const double z = std::min(1.0f, std::abs(d.z()));
      const double angle = std::acos(z) * 180 / std::numbers::pi;
      sum += std::min(angle, 90 - angle) / static_cast<double>(field.directions.size());
    }
    return sum;
  };
  double without = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) without += mean_angle({}, seed) / 4;
  EXPECT_GT(without, 5);
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    CurvatureAlignment soft, hard;
    soft.strength = 0.5f;
    hard.hard_degrees = 10;
    EXPECT_LT(mean_angle(soft, seed), 1);
    EXPECT_LT(mean_angle(hard, seed), 1);
  }
  EXPECT_TRUE(curvature_constraints(hierarchy.levels[0], 0.4f, {}).empty());
}

}  // namespace
}  // namespace meshgrain
