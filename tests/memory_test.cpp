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

/// The message of an error; empty if there was none.
template <typename Call>
std::string error_of(const Call& call) {
  try {
    call();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

std::string refusal(const Mesh& input, const RemeshOptions& options) {
  return error_of([&] { remesh(input, options); });
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

/// As of an input in other units than the edge length.
TEST(Memory, MoreFacesThanCanBeCountedAreRefusedWithoutALimit) {
  Mesh cloud = sample_shape("sphere", 0.3);
  cloud.faces.clear();
  for (const Mesh& input : {sample_shape("sphere", 0.3), cloud}) {
    EXPECT_NE(refusal(input, with_faces(2000000000, 0)).find("more than 1000000000: ask for fewer"),
              std::string::npos);
    RemeshOptions options;
    options.edge_length = 1e-12;
    const std::string text = refusal(input, options);
    EXPECT_NE(text.find("e+25 faces, more than 1000000000: ask for longer edges"),
              std::string::npos)
        << text;
  }
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
  const std::string expected = "more than the limit of 1.0 GiB: ask for fewer faces";
  const std::size_t counts[] = {200, 10000000};
  const std::string of_levels = error_of([&] { remesh_levels(input, counts, options); });
  EXPECT_NE(of_levels.find(expected), std::string::npos) << of_levels;
  options.face_count = counts[1];
  options.symmetry.axes[0] = true;
  const std::string of_half = refusal(input, options);
  EXPECT_NE(of_half.find(expected), std::string::npos) << of_half;
}

}  // namespace
}  // namespace meshgrain
