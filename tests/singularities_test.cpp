#include "meshgrain/singularities.h"

#include <gtest/gtest.h>

#include "field/jumps.h"
#include "field/rosy.h"
#include "made_fields.h"
#include "made_graph.h"
#include "meshgrain/statistics.h"

namespace meshgrain {
namespace {

constexpr double pi = std::numbers::pi;

OrientationField random_field(const Graph& graph, int rosy, std::uint64_t seed) {
  OrientationField field{rosy, {}};
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const float angle = 3.14159f * made::noise(i + 100000 * seed);
    const Vec3 u = any_tangent(graph.normals[i]);
    field.directions.push_back(std::cos(angle) * u + std::sin(angle) * graph.normals[i].cross(u));
  }
  return field;
}

int sum_of_indices(const std::vector<OrientationSingularity>& found) {
  int sum = 0;
  for (const OrientationSingularity& s : found) sum += s.index;
  return sum;
}

/// Poincaré and Hopf: for any field whatever, the indices sum to the Euler number.
TEST(OrientationSingularities, SumToTheEulerNumber) {
  for (const auto& [name, number] :
       {std::pair{"sphere", 2}, {"torus", 0}, {"three-holes", -4}, {"bracket", 0}}) {
    const Mesh mesh = sample_shape(name, 0.5);
    ASSERT_EQ(mesh_statistics(mesh).non_manifold_edges, 0u);
    const Hierarchy hierarchy = build_hierarchy(build_graph(mesh));
    const Graph& graph = hierarchy.levels[0];
    const int euler = static_cast<int>(mesh_statistics(mesh).euler);
    EXPECT_EQ(euler, number);
    for (const int rosy : {1, 2, 4, 6}) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(rosy));
      for (std::uint64_t seed = 0; seed < 3; ++seed) {
        const auto found =
            orientation_singularities(mesh, graph.normals, random_field(graph, rosy, seed));
        EXPECT_EQ(sum_of_indices(found), rosy * euler);
        EXPECT_GT(found.size(), mesh.faces.size() / 20);
      }
      OrientationOptions options;
      options.rosy = rosy;
      for (const auto energy : {OrientationEnergy::extrinsic, OrientationEnergy::intrinsic}) {
        options.energy = energy;
        const auto found =
            orientation_singularities(mesh, graph.normals, solve_orientation(hierarchy, options));
        EXPECT_EQ(sum_of_indices(found), rosy * euler);
        EXPECT_LT(found.size(), mesh.faces.size() / 20);
      }
    }
  }
}

/// A cross field that turns k / 4 times around the middle of a plate. More than a quarter in one
/// triangle are too many to be told apart, and show up as several near each other.
TEST(OrientationSingularities, FindTheOneThatWasMade) {
  const Mesh mesh = made::grid(9, 9, false, false, [](double u, double v) -> Vec3 {
    return Eigen::Vector3d(u - 0.52, v - 0.49, 0).cast<float>();
  });
  const Graph graph = build_graph(mesh);
  for (const int k : {-3, -1, 0, 1, 2}) {
    OrientationField field{4, {}};
    for (const Vec3& p : graph.positions) {
      const float angle = static_cast<float>(k) / 4 * std::atan2(p.y(), p.x());
      field.directions.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    const auto found = orientation_singularities(mesh, graph.normals, field);
    EXPECT_EQ(sum_of_indices(found), k);
    if (std::abs(k) > 1) continue;
    EXPECT_EQ(found.size(), k == 0 ? 0u : 1u);
    for (const OrientationSingularity& s : found) {
      // The triangle around the origin.
      const auto face = mesh.faces[s.face];
      double turn = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3 &a = mesh.positions[face[c]], &b = mesh.positions[face[(c + 1) % 3]];
        turn += std::atan2(a.cross(b).z(), a.dot(b));
      }
      EXPECT_NEAR(turn, 2 * pi, 1e-3);
    }
  }
}

Mesh flat_plate() {
  return made::grid(40, 40, false, false, [](double u, double v) -> Vec3 {
    return Eigen::Vector3d(u, v, 0).cast<float>();
  });
}

TEST(PositionSingularities, AParametrizationOfAPlateHasNone) {
  const Mesh mesh = flat_plate();
  const Graph graph = build_graph(mesh);
  for (const int symmetry : {4, 6}) {
    for (const double turned : {0.0, 0.3}) {
      const Vec3 u = Eigen::Vector3d(std::cos(turned), std::sin(turned), 0).cast<float>();
      const Vec3 w(-u.y(), u.x(), 0);
      auto [orientation, position] =
          made::sample_fields(graph, symmetry, 0.13f, [&](const Vec3& p) -> made::Coordinates {
            if (symmetry == 4) return {p.dot(u), p.dot(w), u};
            const double b = p.dot(w) / std::sqrt(0.75);
            return {p.dot(u) - b / 2, b, u};
          });
      // Representatives may be turned at will.
      for (std::size_t i = 0; i < graph.size(); ++i) {
        for (std::size_t k = 0; k < i % static_cast<std::size_t>(symmetry); ++k) {
          Vec3& o = orientation.directions[i];
          o = symmetry == 4 ? Vec3(-o.y(), o.x(), 0)
                            : Vec3(0.5f * o + 0.866025404f * Vec3(-o.y(), o.x(), 0));
        }
      }
      for (const auto energy : {PositionEnergy::extrinsic, PositionEnergy::intrinsic}) {
        EXPECT_TRUE(position_singularities(mesh, graph, orientation, position, energy).empty());
      }
    }
  }
}

TEST(PositionSingularities, AParametrizationOfATorusHasNone) {
  // So slender that the inner edges are hardly shorter than the outer ones: 200 x 5 cells.
  const double major = 8, minor = 0.25;
  const Mesh mesh = made::grid(1000, 30, true, true, [&](double u, double v) -> Vec3 {
    const double a = 2 * pi * u, b = 2 * pi * v, r = major + minor * std::cos(b);
    return Eigen::Vector3d(r * std::cos(a), r * std::sin(a), minor * std::sin(b)).cast<float>();
  });
  const Graph graph = build_graph(mesh);
  const double rho = 2 * pi * minor / 6;
  const double cells = std::round(2 * pi * major / rho);
  const auto fields = made::sample_fields(
      graph, 4, static_cast<float>(rho), [&](const Vec3& p) -> made::Coordinates {
        const double a = std::atan2(p.y(), p.x());
        const double b = std::atan2(p.z(), std::hypot(p.x(), p.y()) - major);
        return {a / (2 * pi) * cells * rho, b * minor, Vec3(-p.y(), p.x(), 0).normalized()};
      });
  for (const auto energy : {PositionEnergy::extrinsic, PositionEnergy::intrinsic}) {
    EXPECT_TRUE(
        position_singularities(mesh, graph, fields.orientation, fields.position, energy).empty());
  }
}

/// One more column of cells above than below: a dislocation in the middle, of one step.
TEST(PositionSingularities, FindADislocation) {
  const Mesh mesh = flat_plate();
  const Graph graph = build_graph(mesh);
  const float rho = 0.2f;
  const auto fields = made::sample_fields(graph, 4, rho, [&](const Vec3& p) -> made::Coordinates {
    // The phase of a wave gains one turn around the point (0.51, 0.49).
    const double turn = std::atan2(p.y() - 0.49, p.x() - 0.51) / (2 * pi);
    return {p.x() + rho * turn, p.y(), Vec3::UnitX()};
  });
  for (const auto energy : {PositionEnergy::extrinsic, PositionEnergy::intrinsic}) {
    const auto found =
        position_singularities(mesh, graph, fields.orientation, fields.position, energy);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(std::abs(found[0].jump[0]), 1);
    EXPECT_EQ(found[0].jump[1], 0);
    Vec3 centre = Vec3::Zero();
    for (const Index v : mesh.faces[found[0].face]) centre += mesh.positions[v] / 3;
    EXPECT_LT((centre - Vec3(0.51f, 0.49f, 0)).norm(), 0.03f);
  }
  EXPECT_TRUE(orientation_singularities(mesh, graph.normals, fields.orientation).empty());
}

/// Jumps there and back cancel: an edge's integers seen from both ends are opposite.
TEST(Jumps, ThereAndBackCancel) {
  const Hierarchy hierarchy = build_hierarchy(build_graph(sample_shape("blob", 0.4)));
  const Graph& graph = hierarchy.levels[0];
  for (const int symmetry : {4, 6}) {
    OrientationOptions orientation;
    orientation.rosy = symmetry;
    PositionOptions position;
    position.posy = symmetry;
    const auto directions = solve_orientation(hierarchy, orientation);
    const auto points = solve_position(hierarchy, directions, 0.2f, position);
    std::vector<std::array<Index, 2>> edges;  // in the order of Graph::neighbors
    for (Index i = 0; i < graph.size(); ++i) {
      for (const Index j : graph.neighbors_of(i)) edges.push_back({i, j});
    }
    const auto jumps = edge_jumps(graph, directions, points, position.energy, edges);
    std::size_t different = 0;
    for (Index i = 0; i < graph.size(); ++i) {
      for (Index e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
        const Jump &there = jumps[e], &back = jumps[graph.entry(graph.neighbors[e], i)];
        EXPECT_EQ((there.rotation + back.rotation) % symmetry, 0);
        const auto t = rotate_jump(back.t, back.rotation, symmetry);
        different += t[0] != -there.t[0] || t[1] != -there.t[1];
      }
    }
    // Ties between equal pairs are broken by rounding.
    EXPECT_LE(different, graph.neighbors.size() / 500);
  }
}

TEST(Jumps, RotateLikeTheLattice) {
  for (const int posy : {4, 6}) {
    const std::array<int, 2> t{3, -2};
    const double step = 2 * pi / posy;
    const auto place = [&](const std::array<int, 2>& x) {
      return Eigen::Vector2d(x[0] + x[1] * std::cos(step), x[1] * std::sin(step));
    };
    for (int k = 0; k <= posy; ++k) {
      const Eigen::Vector2d expected = Eigen::Rotation2Dd(k * step) * place(t);
      EXPECT_LT((place(rotate_jump(t, k, posy)) - expected).norm(), 1e-9) << k;
    }
  }
}

}  // namespace
}  // namespace meshgrain
