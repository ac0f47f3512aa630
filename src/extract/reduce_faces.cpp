#include "extract/reduce_faces.h"

#include <utility>

#include "extract/collect_faces.h"
#include "extract/extraction_map.h"
#include "extract/face_repair.h"

namespace meshgrain {

std::size_t reduce_faces(Extraction& extraction, int posy, std::size_t count,
                         const Context& context) {
  ExtractionMap parts(extraction, context);
  if (parts.map.vertices() != extraction.mesh.positions.size()) return 0;
  FaceRepair repair(parts.map, parts.clusters, posy, std::move(parts.holes),
                    std::move(parts.lines));
  const std::size_t done =
      posy == 4 ? repair.close_quads(count) : repair.contract_edges(count, context);
  std::vector<Index> vertex;
  if (done > 0) extraction = collect_faces(parts.map, repair, parts.clusters, vertex);
  return done;
}

}  // namespace meshgrain
