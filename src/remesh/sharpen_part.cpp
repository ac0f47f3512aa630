#include "remesh/sharpen_part.h"

#include "sharpen/sharpen.h"

namespace meshgrain {

bool sharpen_part(Mesh& triangles, const RemeshOptions& options, double face_side,
                  std::vector<std::string>& notes, const Context& context) {
  if (options.features.creases != Creases::automatic) return false;
  if (options.graph.nodes != GraphNodes::vertices) return false;  // these have no lines
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

}  // namespace meshgrain
