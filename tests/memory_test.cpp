#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "meshgrain/error.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"

namespace meshgrain {
namespace {

constexpr std::size_t mib = std::size_t{1} << 20;

RemeshOptions with_faces(std::size_t count, std::size_t memory_limit) {
  RemeshOptions options;
  options.face_count = count;
  options.memory_limit = memory_limit;
  return options;
}

/// The message of the refusal; empty if there was none.
std::string refusal(const Mesh& input, const RemeshOptions& options) {
  try {
    remesh(input, options);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(Memory, NoLimitUnlessGiven) {
  EXPECT_EQ(RemeshOptions().memory_limit, 0u);
}

TEST(Memory, AcceptsWhatFits) {
  EXPECT_EQ(refusal(sample_shape("sphere", 0.3), with_faces(200, 1024 * mib)), "");
}

TEST(Memory, RefusesTooManyFaces) {
  const std::string text = refusal(sample_shape("sphere", 0.3), with_faces(10000000, 1024 * mib));
  EXPECT_TRUE(text.starts_with("this may take ")) << text;
  EXPECT_NE(text.find(" GiB of memory, more than the limit of 1.0 GiB: ask for fewer faces"),
            std::string::npos)
      << text;
}

TEST(Memory, RefusesShortEdges) {
  RemeshOptions options;
  options.edge_length = 1e-4;
  options.memory_limit = 1024 * mib;
  const std::string text = refusal(sample_shape("sphere", 0.3), options);
  EXPECT_NE(text.find("longer edges"), std::string::npos) << text;
}

/// Fewer faces would not help.
TEST(Memory, RefusesALargeInput) {
  const std::string text = refusal(sample_shape("blob", 2), with_faces(200, 8 * mib));
  EXPECT_NE(text.find("limit of 8 MiB: take a coarser input"), std::string::npos) << text;
  Mesh cloud = sample_shape("blob", 2);
  cloud.faces.clear();
  EXPECT_NE(refusal(cloud, with_faces(200, 8 * mib)).find("coarser input"), std::string::npos);
}

TEST(Memory, LevelsAndSymmetryHaveTheSameLimit) {
  RemeshOptions options = with_faces(0, 1024 * mib);
  const Mesh input = sample_shape("sphere", 0.3);
  const std::size_t counts[] = {200, 10000000};
  EXPECT_THROW(remesh_levels(input, counts, options), Error);
  options.face_count = counts[1];
  options.symmetry.axes[0] = true;
  EXPECT_NE(refusal(input, options).find("fewer faces"), std::string::npos);
}

}  // namespace
}  // namespace meshgrain
