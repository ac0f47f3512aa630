#include "remesh/take_out_noise.h"

#include "denoise/denoise.h"

namespace meshgrain {

bool take_out_noise(Mesh& triangles, const RemeshOptions& options, double face_side,
                    std::vector<std::string>& notes, const Context& context) {
  if (options.features.creases != Creases::automatic) return false;
  if (options.graph.nodes != GraphNodes::vertices) return false;  // these have no lines
  if (!sharpen_noisy_part(triangles, face_side, context)) return false;
  notes.emplace_back(
      "a noisy scan of a mechanical part: its noise was taken out to make its creases sharp");
  return true;
}

}  // namespace meshgrain
