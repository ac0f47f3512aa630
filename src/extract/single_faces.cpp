#include "extract/single_faces.h"

#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

#include "extract/collect_faces.h"
#include "extract/drop_unused.h"
#include "extract/extraction_map.h"
#include "extract/face_repair.h"
#include "extract/rename_vertices.h"

namespace meshgrain {
namespace {

/// The vertices of a map that were several times one vertex of the mesh, which was cut there.
std::vector<Index> parted_vertices(const ExtractionMap& parts, std::size_t mesh_vertices) {
  std::vector<Index> result;
  if (parts.map.vertices() == mesh_vertices) return result;
  std::vector<std::uint8_t> times(mesh_vertices, 0);
  for (const Index v : parts.sources) times[v] = static_cast<std::uint8_t>(times[v] == 0 ? 1 : 2);
  for (Index v = 0; v < parts.sources.size(); ++v) {
    if (times[parts.sources[v]] > 1) result.push_back(v);
  }
  return result;
}

/// Makes them one again. `vertex`: what each vertex of the map is now.
void join_parted(Extraction& extraction, std::span<const Index> sources,
                 std::span<const Index> parted, std::span<const Index> vertex) {
  if (parted.empty()) return;
  std::map<Index, Index> first;  // of those that were one
  std::vector<Index> becomes(extraction.mesh.positions.size());
  std::iota(becomes.begin(), becomes.end(), Index{0});
  for (const Index v : parted) {
    if (vertex[v] == no_index) continue;
    becomes[vertex[v]] = first.try_emplace(sources[v], vertex[v]).first->second;
  }
  rename_vertices(extraction, becomes);
  drop_unused(extraction);
}

/// Lets `change` repair a mesh, and returns how often it says that it did.
template <typename Change>
std::size_t change_faces(Extraction& extraction, int posy, const Change& change,
                         const Context& context) {
  ExtractionMap parts(extraction, context);
  // Where pieces meet nothing may change, so that they still do.
  const std::vector<Index> parted = parted_vertices(parts, extraction.mesh.positions.size());
  const std::vector<std::uint8_t> hold = parts.clusters.hold;
  for (const Index v : parted) parts.clusters.hold[v] = at_corner;
  FaceRepair repair(parts.map, parts.clusters, posy, std::move(parts.holes),
                    std::move(parts.lines));
  const std::size_t done = change(repair);
  if (done == 0) return 0;
  for (const Index v : parted) parts.clusters.hold[v] = hold[v];
  std::vector<Index> vertex;
  extraction = collect_faces(parts.map, repair, parts.clusters, vertex, context);
  join_parted(extraction, parts.sources, parted, vertex);
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
