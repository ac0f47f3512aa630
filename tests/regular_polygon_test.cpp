#include "finish/regular_polygon.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <complex>
#include <numbers>
#include <numeric>

#include "made_graph.h"
#include "util/dispatch.h"

namespace meshgrain {
namespace {

/// Some faces with n corners near the xy-plane, about one unit large.
Mesh polygons(std::size_t n, std::size_t count) {
  Mesh mesh;
  std::vector<Index> face(n);
  for (std::size_t f = 0; f < count; ++f) {
    for (std::size_t k = 0; k < n; ++k) {
      const auto v = mesh.positions.size();
      const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
      const Vec3 noise(made::noise(3 * v), made::noise(3 * v + 1), made::noise(3 * v + 2));
      mesh.positions.push_back(
          Vec3(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 5) +
          0.2f * noise);
      face[k] = static_cast<Index>(v);
    }
    mesh.faces.push_back(face);
  }
  return mesh;
}

struct Fits {
  std::vector<Vec3> places;
  std::vector<Index> folded;
};

Fits fit(const Mesh& mesh, const PolygonFit& wanted, std::size_t at_once) {
  std::vector<Index> all(mesh.faces.size());
  std::iota(all.begin(), all.end(), Index{0});
  const std::vector<Vec3> normals(mesh.positions.size(), Vec3::UnitZ());
  Fits fits{std::vector<Vec3>(mesh.faces.corners().size()), {}};
  for (std::size_t k = 0; k < all.size(); k += at_once) {
    const std::span some = std::span(all).subspan(k, std::min(at_once, all.size() - k));
    fit_regular_polygons(mesh, some, normals, wanted, fits.places, fits.folded);
  }
  return fits;
}

/// The polygon of one face by complex numbers in its mean plane.
std::vector<Vec3> reference(const Mesh& mesh, std::size_t f, const PolygonFit& wanted) {
  using Complex = std::complex<double>;
  const auto face = mesh.faces[f];
  const std::size_t n = face.size();
  Eigen::Vector3d center = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector3d p = mesh.positions[face[k]].cast<double>();
    center += p / static_cast<double>(n);
    normal += p.cross(mesh.positions[face[(k + 1) % n]].cast<double>());
  }
  normal.normalize();
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  const double step = 2 * std::numbers::pi / static_cast<double>(n);
  Complex coefficient = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector3d p = mesh.positions[face[k]].cast<double>() - center;
    coefficient += Complex(p.dot(u), p.dot(v)) * std::polar(1.0, -step * static_cast<double>(k));
  }
  coefficient /= static_cast<double>(n);
  const double size = wanted.side / (2 * std::sin(step / 2));
  coefficient *= 1 - wanted.evenness + wanted.evenness * size / std::abs(coefficient);
  std::vector<Vec3> places;
  for (std::size_t k = 0; k < n; ++k) {
    const Complex z = coefficient * std::polar(1.0, step * static_cast<double>(k));
    places.push_back((center + z.real() * u + z.imag() * v).cast<float>());
  }
  return places;
}

TEST(RegularPolygon, IsTheFirstFourierCoefficient) {
  const EdgeLength one(1.0f);
  const PolygonFit wanted{1.3f, 0.6f, one};
  for (const std::size_t n : {3, 4, 5, 6, 9}) {
    const Mesh mesh = polygons(n, 40);
    const Fits fits = fit(mesh, wanted, mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto expected = reference(mesh, f, wanted);
      for (std::size_t k = 0; k < n; ++k) {
        EXPECT_LT((fits.places[n * f + k] - expected[k]).norm(), 2e-5) << n << ' ' << f;
      }
    }
  }
}

TEST(RegularPolygon, FacesWithoutExtentStayPoints) {
  Mesh mesh = polygons(4, 1);
  for (Vec3& p : mesh.positions) p = Vec3(1, 2, 3);
  const EdgeLength one(1.0f);
  const Fits fits = fit(mesh, {1.0f, 0.5f, one}, 1);
  for (const Vec3& p : fits.places) EXPECT_EQ(p, Vec3(1, 2, 3));
  EXPECT_EQ(fits.folded, std::vector<Index>{0});
}

TEST(RegularPolygon, SaysWhatIsFolded) {
  Mesh mesh = polygons(5, 40);
  const std::vector<Index> folded{3, 17, 39};
  for (const Index f : folded) mesh.positions[5 * f].x() = -2;
  const EdgeLength one(1.0f);
  EXPECT_EQ(fit(mesh, {1.0f, 0.5f, one}, mesh.faces.size()).folded, folded);
}

TEST(RegularPolygon, DoesNotDependOnTheNumberOfLanes) {
  const EdgeLength sizes(std::vector<float>(1000, 0.7f));
  for (const std::size_t n : {3, 4, 5}) {
    const Mesh mesh = polygons(n, 100);
    const PolygonFit wanted{1.3f, 0.6f, sizes};
    const std::int64_t targets = simd_targets();
    const Fits expected = fit(mesh, wanted, mesh.faces.size());
    for (int bit = 0; bit < 63; ++bit) {
      const std::int64_t target = std::int64_t{1} << bit;
      if ((targets & target) == 0) continue;
      pretend_simd_targets(target);
      for (const std::size_t at_once : {1, 3, 16, 1000}) {
        const Fits fits = fit(mesh, wanted, at_once);
        EXPECT_EQ(fits.places, expected.places) << hwy::TargetName(target) << ' ' << at_once;
        EXPECT_EQ(fits.folded, expected.folded) << hwy::TargetName(target) << ' ' << at_once;
      }
    }
    pretend_simd_targets(0);
  }
}

}  // namespace
}  // namespace meshgrain
