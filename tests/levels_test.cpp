#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "meshgrain/error.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"

namespace meshgrain {
namespace {

TEST(Levels, AreEachAsASingleRunWouldBe) {
  const Mesh input = sample_shape("bracket", 0.5);
  const std::vector<std::size_t> counts{800, 2400, 400};
  RemeshOptions options;
  options.sizing.adaptive = 0.5;
  const std::vector<RemeshResult> levels = remesh_levels(input, counts, options);
  ASSERT_EQ(levels.size(), counts.size());
  for (std::size_t k = 0; k < counts.size(); ++k) {
    SCOPED_TRACE(counts[k]);
    options.face_count = counts[k];
    const RemeshResult single = remesh(input, options);
    const MeshStatistics a = mesh_statistics(levels[k].mesh), b = mesh_statistics(single.mesh);
    EXPECT_NEAR(static_cast<double>(a.faces), static_cast<double>(counts[k]),
                0.0101 * static_cast<double>(counts[k]));
    EXPECT_EQ(a.quads, a.faces);
    EXPECT_EQ(a.euler, b.euler);
    EXPECT_EQ(a.components, b.components);
    EXPECT_EQ(a.inverted_quads, 0u);
    EXPECT_LT(a.angle_sigma, b.angle_sigma + 3);
    EXPECT_EQ(levels[k].report.input_faces, input.faces.size());
    // The finest is the very same.
    if (k == 1) {
      EXPECT_EQ(levels[k].mesh.positions, single.mesh.positions);
    }
  }
}

TEST(Levels, KeepWhatIsPainted) {
  Mesh plate = sample_shape("plate", 0.5);
  for (const Vec3& p : plate.positions) plate.values.push_back(p.x() < 0 ? 4.0f : 1.0f);
  RemeshOptions options;
  options.sizing.kind = Sizing::Kind::density;
  for (const RemeshResult& level :
       remesh_levels(plate, std::array<std::size_t, 2>{2000, 500}, options)) {
    double left = 0;
    for (std::size_t f = 0; f < level.mesh.faces.size(); ++f) {
      left += level.mesh.positions[level.mesh.faces[f][0]].x() < 0;
    }
    // Four fifths, but for the change from one to the other.
    EXPECT_NEAR(left / static_cast<double>(level.mesh.faces.size()), 0.77, 0.07);
  }
}

/// Of marks that are everywhere.
TEST(Levels, EachTellsWhatWasDoneOnce) {
  Mesh plate = sample_shape("plate", 0.5);
  for (std::size_t f = 0; f < plate.faces.size(); ++f) {
    const auto face = std::as_const(plate.faces)[f];
    plate.marked_edges.push_back({face[0], face[1]});
  }
  for (const RemeshResult& level : remesh_levels(plate, std::array<std::size_t, 2>{300, 100})) {
    const auto is_about_marks = [](const std::string& note) {
      return note.starts_with("without creases and marked edges");
    };
    EXPECT_EQ(std::ranges::count_if(level.report.notes, is_about_marks), 1);
  }
}

TEST(Levels, RefuseWhatMakesNoSense) {
  const Mesh input = sample_shape("sphere", 0.3);
  EXPECT_THROW(remesh_levels(input, {}), Error);
  EXPECT_THROW(remesh_levels(input, std::array<std::size_t, 2>{100, 0}), Error);
  RemeshOptions options;
  options.symmetry.automatic = true;
  EXPECT_THROW(remesh_levels(input, std::array<std::size_t, 1>{100}, options), Error);
}

}  // namespace
}  // namespace meshgrain
