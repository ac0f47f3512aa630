#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "measure/face_grid.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"
#include "meshgrain/statistics.h"

namespace meshgrain {

/// How deep two faces pass through each other, in units of length: 0 if they do not, or share an
/// edge. A quad counts with both of its diagonals.
double penetration(const Mesh& mesh, Index f, Index g);
/// The same where the boxes of two different faces meet.
double penetration_of_near(const Mesh& mesh, Index f, Index g);
/// Whether that is more than 0.
bool cross_if_near(const Mesh& mesh, Index f, Index g);

/// Of find_crossings() those with one or both of the faces that are marked, by one flag a face.
std::vector<std::array<Index, 2>> find_crossings_of(const Mesh& mesh,
                                                    std::span<const std::uint8_t> marked,
                                                    const Context& context);

/// How many there are of them with one or both of `some` faces, which increase.
std::size_t count_crossings_of(const Mesh& mesh, std::span<const Index> some,
                               const Context& context);

/// For who asks often: `boxes` of all faces (face_boxes()), of which those of `some` are not looked
/// at.
std::size_t count_crossings_of(const Mesh& mesh, std::span<const Index> some,
                               std::span<const Eigen::AlignedBox3f> boxes, const Context& context);

/// Where there are so many for each face, a mesh is crumpled: far fewer faces were asked for than
/// its topology needs, and nothing can be done about them.
inline constexpr std::size_t hopeless_crossings = 10;

/// Where there are more than faces, hardly anything can be: it is worth this share of the effort.
inline bool is_crumpled(std::size_t crossings, std::size_t faces) {
  return crossings > faces;
}
inline constexpr double effort_if_crumpled = 0.1;

}  // namespace meshgrain
