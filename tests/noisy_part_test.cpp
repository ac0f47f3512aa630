#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kept_creases.h"
#include "made_points.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "same_topology.h"
#include "sharpen/sharpen.h"

namespace meshgrain {
namespace {

Mesh scan(Mesh mesh, double noise = 0.2) {
  add_noise(mesh, noise);
  return mesh;
}

double output_edge(const Mesh& mesh, double faces) {
  return std::sqrt(surface_area(mesh) / faces);
}

TEST(NoisyPart, PartsGetTheirCreasesBack) {
  for (const char* name : {"cube", "cylinder", "bracket", "shaft", "twisted-cube", "fused-boxes"}) {
    SCOPED_TRACE(name);
    const Mesh part = sample_shape(name, 3);
    RemeshOptions options;
    options.face_count = 5000;
    const RemeshResult result = remesh(scan(part), options);
    made::expect_same_topology(mesh_statistics(result.mesh), mesh_statistics(part));
    EXPECT_GE(made::kept_creases(part, result.mesh).creases, 0.96);
    EXPECT_EQ(result.report.notes.size(), 1u);
  }
}

/// Of which a sample shows less: patches of it lie between all creases.
TEST(NoisyPart, FineScansOfRoundPartsAreTold) {
  for (const auto& [name, resolution] : {std::pair{"shaft", 4.0}, {"cylinder", 6.0}}) {
    SCOPED_TRACE(name);
    const Mesh part = sample_shape(name, resolution);
    RemeshOptions options;
    options.face_count = 3000;
    const RemeshResult result = remesh(scan(part), options);
    EXPECT_GE(made::kept_creases(part, result.mesh).creases, 0.96);
    EXPECT_EQ(result.report.notes.size(), 1u);
  }
}

/// Where no edge of the scan lies along a crease.
TEST(NoisyPart, CreasesAreFoundBetweenTheSamples) {
  RemeshOptions triangles;
  triangles.faces = OutputFaces::triangles;
  triangles.features.creases = Creases::none;
  triangles.face_count = 60000;
  triangles.smoothing = 5;
  const Mesh part = sample_shape("cube", 2);
  const Mesh sampled = remesh(part, triangles).mesh;
  RemeshOptions options;
  options.face_count = 3000;
  const Mesh result = remesh(scan(sampled), options).mesh;
  EXPECT_GE(made::kept_creases(part, result).creases, 0.9);
}

TEST(NoisyPart, SurfacesComeNearerToThePart) {
  const Mesh part = sample_shape("cube", 2);
  Mesh surface = scan(part);
  ASSERT_EQ(sharpen(surface, output_edge(part, 2000), Context()), Blur::noise);
  const auto off = [](const Mesh& mesh) {  // mean distance from the faces of the unit cube
    double sum = 0;
    for (const Vec3& p : mesh.positions) sum += std::abs(p.cwiseAbs().maxCoeff() - 0.5f);
    return sum / static_cast<double>(mesh.positions.size());
  };
  EXPECT_LT(off(surface), 0.4 * off(scan(part)));
}

/// Sculptures, noisy or not, and parts without noise.
TEST(NoisyPart, AllElseStaysAsItIs) {
  for (const char* name : {"sphere", "torus", "blob", "three-holes"}) {
    for (const double noise : {0.0, 0.05, 0.2, 0.4}) {
      const Mesh before = scan(sample_shape(name), noise);
      Mesh after = before;
      EXPECT_EQ(sharpen(after, output_edge(before, 2000), Context()), Blur::none) << name;
      EXPECT_EQ(after.positions, before.positions);
      EXPECT_TRUE(after.marked_edges.empty());
    }
  }
  Mesh part = sample_shape("bracket");
  EXPECT_EQ(sharpen(part, output_edge(part, 2000), Context()), Blur::none);
}

/// The ridges of a small sculpture are as noise would be: nothing tells them apart.
TEST(NoisyPart, CoarseScansStayAsTheyAre) {
  const Mesh before = scan(sample_shape("bracket", 0.6), 0.2);
  ASSERT_LT(before.positions.size(), 2000u);
  Mesh after = before;
  EXPECT_EQ(sharpen(after, output_edge(before, 500), Context()), Blur::none);
  EXPECT_EQ(after.positions, before.positions);
}

/// Each has too few vertices to tell noise from facets, however many there are.
TEST(NoisyPart, ManyLowPolyStonesStayAsTheyAre) {
  const Mesh stone = scan(sample_shape("sphere", 0.15), 0.3);
  ASSERT_LT(stone.positions.size(), 100u);
  Mesh before;
  for (int k = 0; before.positions.size() < 4000; ++k) {
    const auto first = static_cast<Index>(before.positions.size());
    for (const Vec3& p : stone.positions) {
      before.positions.push_back(p + Vec3(3 * static_cast<float>(k), 0, 0));
    }
    for (std::size_t f = 0; f < stone.faces.size(); ++f) {
      const auto face = stone.faces[f];
      before.faces.push_back({first + face[0], first + face[1], first + face[2]});
    }
  }
  Mesh after = before;
  EXPECT_EQ(sharpen(after, output_edge(before, 5000), Context()), Blur::none);
  EXPECT_EQ(after.positions, before.positions);
}

/// Few sides around a tube meet at angles that noise has, too.
TEST(NoisyPart, CoarseTubesStayAsTheyAre) {
  constexpr std::size_t rings = 12, around = 48, across = 16;
  const made::Sample ring = made::torus(around, across, 1, 0.18);
  Mesh chain;
  for (std::size_t k = 0; k < rings; ++k) {
    for (const Vec3& p : ring.points) {
      chain.positions.push_back(p + Vec3(3 * static_cast<float>(k), 0, 0));
    }
    const auto at = [&](std::size_t i, std::size_t j) {
      return static_cast<Index>((k * around + i % around) * across + j % across);
    };
    for (std::size_t i = 0; i < around; ++i) {
      for (std::size_t j = 0; j < across; ++j) {
        chain.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        chain.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  EXPECT_EQ(sharpen(chain, output_edge(chain, 3000), Context()), Blur::none);
}

TEST(NoisyPart, SymmetryComesAfterIt) {
  const Mesh part = sample_shape("cylinder", 2);
  RemeshOptions options;
  options.face_count = 3000;
  options.symmetry.axes[0] = true;
  const RemeshResult result = remesh(scan(part), options);
  made::expect_same_topology(mesh_statistics(result.mesh), mesh_statistics(part));
  EXPECT_GE(made::kept_creases(part, result.mesh).creases, 0.96);
  EXPECT_EQ(result.report.notes.size(), 2u);  // this, and that it was made symmetric
}

TEST(NoisyPart, CanBeLeftOut) {
  RemeshOptions options;
  options.face_count = 2000;
  options.features.creases = Creases::none;
  EXPECT_TRUE(remesh(scan(sample_shape("cube", 2)), options).report.notes.empty());
}

TEST(NoisyPart, DoesNotDependOnThreads) {
  Mesh one = scan(sample_shape("bracket", 2)), three = one;
  const double edge = output_edge(one, 2000);
  ASSERT_EQ(sharpen(one, edge, Context(1)), Blur::noise);
  ASSERT_EQ(sharpen(three, edge, Context(3)), Blur::noise);
  EXPECT_EQ(one.positions, three.positions);
  EXPECT_EQ(one.marked_edges, three.marked_edges);
}

}  // namespace
}  // namespace meshgrain
