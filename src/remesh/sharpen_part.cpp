#include "remesh/sharpen_part.h"

#include <algorithm>

#include "mesh/part.h"
#include "sharpen/narrow_bends.h"
#include "sharpen/round_again.h"
#include "sharpen/sharpen.h"

namespace meshgrain {
namespace {

bool may_sharpen(const RemeshOptions& options) {
  return options.features.creases == Creases::automatic &&
         options.graph.nodes == GraphNodes::vertices;  // others have no lines
}

/// The triangles that have all of their corners at some positions.
Mesh with_corners_at(const std::vector<Vec3>& positions, const Mesh& triangles) {
  const auto comes_before = [](const Vec3& a, const Vec3& b) {
    return std::ranges::lexicographical_compare(a, b);
  };
  std::vector<Vec3> sorted = positions;
  std::ranges::sort(sorted, comes_before);
  const auto is_there = [&](Index v) {
    return std::ranges::binary_search(sorted, triangles.positions[v], comes_before);
  };
  std::vector<Index> faces;
  for (Index f = 0; f < triangles.faces.size(); ++f) {
    if (std::ranges::all_of(triangles.faces[f], is_there)) faces.push_back(f);
  }
  auto [mesh, vertices] = part_of(triangles, faces);
  for (const Index v : vertices) mesh.values.push_back(triangles.values[v]);
  return mesh;
}

}  // namespace

bool sharpen_part(Mesh& triangles, const RemeshOptions& options, double face_side,
                  std::vector<std::string>& notes, const Context& context) {
  if (!may_sharpen(options)) return false;
  switch (sharpen(triangles, face_side, context)) {
    case Blur::none:
      return false;
    case Blur::noise:
      notes.emplace_back(
          "a noisy scan of a mechanical part: its noise was taken out to make its creases sharp");
      return true;
    case Blur::chamfers:
      notes.emplace_back(
          "a mechanical part sampled on a grid that has cut its creases off: they were made sharp "
          "again (-c off leaves them)");
      return true;
  }
  return false;
}

bool sharpen_narrow_bends(Mesh& triangles, const RemeshOptions& options, double face_side,
                          Mesh* roundings, std::vector<std::string>& notes,
                          const Context& context) {
  if (!may_sharpen(options)) return false;
  constexpr double narrow = 0.5, chamfer = 0.3;  // of a side
  const std::vector<Vec3> positions = triangles.positions;
  bool any = false;
  for (const double width : {narrow, 1.0, 2.0}) {
    if (width > narrow && roundings == nullptr) break;
    const Mesh bent = sharpen_bends(
        triangles, {.chamfer = chamfer * face_side, .rounding = width * face_side}, context);
    if (bent.faces.empty()) continue;
    any = true;
    if (width == narrow) {
      notes.emplace_back(
          "made sharp edges of chamfers and roundings far narrower than a face (-c off leaves "
          "them)");
    } else {
      // Others lead to where a narrower bend was made sharp before.
      add_triangles(*roundings, with_corners_at(positions, bent));
    }
  }
  return any;
}

}  // namespace meshgrain
