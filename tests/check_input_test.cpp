#include "remesh/check_input.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "meshgrain/error.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"

namespace meshgrain {
namespace {

/// Files are checked when they are read; a caller of the library may hand over anything.
TEST(CheckInput, RefusesWhatIsNoMesh) {
  const auto error_of = [](const std::function<void(Mesh&)>& spoil) -> std::string {
    Mesh mesh = sample_shape("cube", 0.2);
    spoil(mesh);
    try {
      remesh(mesh, {});
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  };
  const auto count = static_cast<Index>(sample_shape("cube", 0.2).positions.size());
  EXPECT_EQ(error_of([](Mesh&) {}), "none");
  EXPECT_EQ(
      error_of([&](Mesh& mesh) { mesh.faces[3][1] = count; }),
      fmt::format("face 3 of the input has the vertex {0}, but there are {0} vertices", count));
  EXPECT_EQ(error_of([&](Mesh& mesh) {
              mesh.marked_edges = {{0, 1}, {no_index, 1}};
            }),
            fmt::format("a marked edge of the input has the vertex {}, but there are {} vertices",
                        no_index, count));
  EXPECT_EQ(error_of([](Mesh& mesh) { mesh.positions[5].y() = NAN; }),
            "vertex 5 of the input is not finite");
  EXPECT_EQ(error_of([](Mesh& mesh) { mesh.origin.x() = INFINITY; }),
            "the origin of the input is not finite");
  EXPECT_EQ(error_of([](Mesh& mesh) { mesh.normals.resize(2, Vec3::UnitX()); }),
            fmt::format("the input has 2 normals for {} vertices", count));
}

}  // namespace
}  // namespace meshgrain
