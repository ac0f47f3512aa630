#include "mesh/part.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "meshgrain/shapes.h"

namespace meshgrain {
namespace {

TEST(Part, HasTheFacesInTheirOrder) {
  const Mesh whole = sample_shape("cube");
  const std::vector<Index> faces{7, 2, 3};
  const Part part = part_of(whole, faces);
  ASSERT_EQ(part.mesh.faces.size(), faces.size());
  ASSERT_EQ(part.mesh.positions.size(), part.vertices.size());
  for (std::size_t v = 0; v < part.vertices.size(); ++v) {
    EXPECT_EQ(part.mesh.positions[v], whole.positions[part.vertices[v]]);
    EXPECT_EQ(part.number(part.vertices[v]), v);
    if (v > 0) {
      EXPECT_LT(part.vertices[v - 1], part.vertices[v]);
    }
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto here = part.mesh.faces[f], there = whole.faces[faces[f]];
    ASSERT_EQ(here.size(), there.size());
    for (std::size_t k = 0; k < here.size(); ++k) {
      EXPECT_EQ(part.vertices[here[k]], there[k]);
    }
  }
}

TEST(Part, KnowsNoOtherVertices) {
  const Mesh whole = sample_shape("cube");
  const Part part = part_of(whole, std::vector<Index>{0});
  EXPECT_EQ(part.vertices.size(), whole.faces.degree(0));
  std::size_t known = 0;
  for (Index v = 0; v < whole.positions.size(); ++v) known += part.number(v) != no_index;
  EXPECT_EQ(known, part.vertices.size());
  EXPECT_TRUE(part_of(whole, {}).vertices.empty());
}

}  // namespace
}  // namespace meshgrain
