#include "meshgrain/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace meshgrain {
namespace {

TEST(Faces, StaysUniformWhileDegreesAgree) {
  Faces faces;
  faces.push_back({0, 1, 2});
  faces.push_back({2, 1, 3});
  EXPECT_EQ(faces.uniform_degree(), 3u);
  EXPECT_EQ(faces.size(), 2u);
  EXPECT_EQ(faces[1][2], 3u);
}

TEST(Faces, MixedDegreesKeepEveryFace) {
  Faces faces;
  faces.push_back({0, 1, 2});
  faces.push_back({2, 1, 3, 4});
  faces.push_back({4, 3, 5, 6, 7});
  EXPECT_EQ(faces.uniform_degree(), 0u);
  ASSERT_EQ(faces.size(), 3u);
  EXPECT_EQ(faces.degree(0), 3u);
  EXPECT_EQ(faces.degree(1), 4u);
  EXPECT_EQ(faces.degree(2), 5u);
  EXPECT_EQ(faces[2][4], 7u);
  EXPECT_EQ(faces[0][0], 0u);
}

TEST(Faces, ManyAtOnceAreTheSameAsOneByOne) {
  const std::vector<Index> triangles = {0, 1, 2, 2, 1, 3}, quads = {4, 5, 6, 7};
  Faces faces, expected;
  for (const auto& [corners, degree] : {std::pair(triangles, 3), std::pair(triangles, 3),
                                        std::pair(quads, 4), std::pair(triangles, 3)}) {
    const auto n = static_cast<std::size_t>(degree);
    faces.append(corners, n);
    for (std::size_t k = 0; k < corners.size(); k += n) {
      expected.push_back(std::span(corners).subspan(k, n));
    }
    ASSERT_EQ(faces.size(), expected.size());
    EXPECT_EQ(faces.uniform_degree(), expected.uniform_degree());
    for (std::size_t f = 0; f < faces.size(); ++f) {
      EXPECT_TRUE(std::ranges::equal(std::as_const(faces)[f], std::as_const(expected)[f]));
    }
  }
}

}  // namespace
}  // namespace meshgrain
