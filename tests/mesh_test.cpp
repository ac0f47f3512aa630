#include "meshgrain/mesh.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace meshgrain
