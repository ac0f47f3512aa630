#include "mesh/orient_faces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/border.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "util/hash.h"

namespace meshgrain {
namespace {

void turn(Mesh& mesh, Index f) {
  const auto face = mesh.faces[f];
  std::reverse(face.begin() + 1, face.end());
}

/// Turns about this share of the faces.
std::size_t shuffle(Mesh& mesh, float share) {
  std::size_t count = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (unit_float(hash64(f)) >= share) continue;
    turn(mesh, f);
    ++count;
  }
  return count;
}

float volume(const Mesh& mesh) {
  float sum = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto face = std::as_const(mesh.faces)[f];
    const auto p = [&](std::size_t k) { return mesh.positions[face[k]]; };
    for (std::size_t k = 2; k < face.size(); ++k) sum += p(0).dot(p(k - 1).cross(p(k)));
  }
  return sum / 6;
}

/// A strip around a circle with so many half turns.
Mesh strip(int half_turns) {
  constexpr Index around = 60, across = 7;
  Mesh mesh;
  for (Index i = 0; i < around; ++i) {
    const double angle = 2 * std::numbers::pi * i / around, turned = half_turns * angle / 2;
    for (Index j = 0; j < across; ++j) {
      const double off = 0.1 * (j - (across - 1) / 2.0), radius = 1 + off * std::cos(turned);
      mesh.positions.push_back(Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle),
                                               off * std::sin(turned))
                                   .cast<float>());
    }
  }
  for (Index i = 0; i < around; ++i) {
    for (Index j = 0; j + 1 < across; ++j) {
      const auto vertex = [&](Index column, Index row) {
        const bool is_over = column == around;
        const Index end = is_over && half_turns % 2 == 1 ? across - 1 - row : row;
        return (is_over ? 0 : column) * across + end;
      };
      mesh.faces.push_back(
          {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
  return mesh;
}

TEST(OrientFaces, LeavesWhatAgreesAsItIs) {
  for (const char* name : {"bracket", "plate"}) {
    Mesh mesh = sample_shape(name);
    for (const bool is_inside_out : {false, true}) {
      if (is_inside_out) shuffle(mesh, 1);
      const auto before = mesh.faces.corners();
      EXPECT_EQ(orient_faces(mesh).turned_faces, 0u);
      EXPECT_TRUE(std::ranges::equal(mesh.faces.corners(), before)) << name;
    }
  }
}

TEST(OrientFaces, AFewTurnedFacesFollowTheOthers) {
  Mesh mesh = sample_shape("bracket");
  shuffle(mesh, 1);  // inside out, and meant so
  const float before = volume(mesh);
  const std::size_t turned = shuffle(mesh, 0.1f);
  const OrientReport report = orient_faces(mesh);
  EXPECT_EQ(report.turned_faces, turned);
  EXPECT_EQ(report.one_sided_pieces, 0u);
  EXPECT_FLOAT_EQ(volume(mesh), before);
  EXPECT_TRUE(rim_edges(mesh).empty());
}

TEST(OrientFaces, ShuffledPiecesAreTurnedOutwards) {
  Mesh mesh = sample_shape("torus");
  const float before = volume(mesh);
  for (const float share : {0.4f, 0.5f, 0.6f}) {
    shuffle(mesh, share);
    orient_faces(mesh);
    EXPECT_FLOAT_EQ(volume(mesh), before);
    EXPECT_TRUE(rim_edges(mesh).empty());
  }
}

TEST(OrientFaces, StripsWithOneSideAreCutAcross) {
  for (const int half_turns : {1, 2, 3}) {
    Mesh mesh = strip(half_turns);
    shuffle(mesh, 0.5f);
    EXPECT_EQ(orient_faces(mesh).one_sided_pieces, half_turns % 2 == 1 ? 1u : 0u);
    const std::size_t cut = rim_edges(mesh).size() - border_edges(mesh).size();
    if (half_turns % 2 == 0) {
      EXPECT_EQ(cut, 0u);
    } else {
      EXPECT_GE(cut, 6u);  // as many as there are faces across
      EXPECT_LE(cut, 12u);
    }
  }
}

TEST(OrientFaces, ShuffledInputIsRemeshedLikeAnyOther) {
  RemeshOptions options;
  options.face_count = 600;
  Mesh mesh = sample_shape("three-holes", 0.5);
  shuffle(mesh, 0.5f);
  const RemeshResult result = remesh(mesh, options);
  const MeshStatistics found = mesh_statistics(result.mesh);
  EXPECT_EQ(found.euler, -4);
  EXPECT_EQ(found.boundary_loops, 0u);
  ASSERT_EQ(result.report.notes.size(), 1u);
  EXPECT_NE(result.report.notes[0].find("faces to the side of their neighbours"),
            std::string::npos);
  EXPECT_TRUE(rim_edges(result.mesh).empty());
}

/// The result is a surface on both sides of the cut, and meets itself there.
TEST(OrientFaces, AMobiusStripIsRemeshed) {
  RemeshOptions options;
  options.face_count = 500;
  const RemeshResult result = remesh(strip(1), options);
  EXPECT_NEAR(static_cast<double>(result.mesh.faces.size()), 500, 6);
  const MeshStatistics found = mesh_statistics(result.mesh);
  EXPECT_EQ(found.euler, 0);
  EXPECT_EQ(found.isolated_vertices, 0u);
  EXPECT_EQ(found.inverted_quads, 0u);
  ASSERT_EQ(result.report.notes.size(), 2u);
  EXPECT_NE(result.report.notes[1].find("only one side"), std::string::npos);
}

}  // namespace
}  // namespace meshgrain
