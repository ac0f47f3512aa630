#include "mesh/incidence.h"

namespace meshgrain {

Incidence incident_faces(const Faces& faces, std::size_t vertices) {
  Incidence result;
  result.offsets.assign(vertices + 1, 0);
  for (const Index v : faces.corners()) ++result.offsets[v + 1];
  for (std::size_t v = 0; v < vertices; ++v) result.offsets[v + 1] += result.offsets[v];

  result.faces.resize(faces.corners().size());
  std::vector<Index> next(result.offsets.begin(), result.offsets.end() - 1);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (const Index v : faces[f]) result.faces[next[v]++] = static_cast<Index>(f);
  }
  return result;
}

}  // namespace meshgrain
