#include "extract/single_faces.h"

#include <utility>

#include "extract/collect_faces.h"
#include "extract/extraction_map.h"
#include "extract/face_repair.h"

namespace meshgrain {
namespace {

/// Lets `change` repair a mesh, and returns how often it says that it did.
template <typename Change>
std::size_t change_faces(Extraction& extraction, int posy, const Change& change,
                         const Context& context) {
  ExtractionMap parts(extraction, context);
  if (parts.map.vertices() != extraction.mesh.positions.size()) return 0;
  FaceRepair repair(parts.map, parts.clusters, posy, std::move(parts.holes),
                    std::move(parts.lines));
  const std::size_t done = change(repair);
  std::vector<Index> vertex;
  if (done > 0) extraction = collect_faces(parts.map, repair, parts.clusters, vertex, context);
  return done;
}

}  // namespace

std::size_t remove_single_faces(Extraction& extraction, int posy, std::size_t count,
                                const Context& context) {
  const auto remove = [&](FaceRepair& repair) {
    return posy == 4 ? repair.close_quads(count, context) : repair.contract_edges(count, context);
  };
  return change_faces(extraction, posy, remove, context);
}

std::size_t add_single_quads(Extraction& extraction, std::size_t count, const Context& context) {
  const auto add = [&](FaceRepair& repair) { return repair.open_vertices(count, context); };
  return change_faces(extraction, 4, add, context);
}

}  // namespace meshgrain
