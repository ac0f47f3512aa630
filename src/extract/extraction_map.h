#pragma once

#include <vector>

#include "extract/clusters.h"
#include "extract/polygon_map.h"

namespace meshgrain {

/// An extracted mesh as a map, to be changed and collected again (collect_faces).
struct ExtractionMap {
  ExtractionMap(const Extraction& extraction, const Context& context);

  PolygonMap map;
  std::vector<Index> sources;       // of each vertex, that of the extraction
  std::vector<Index> corners;       // of each halfedge, its place in the mesh's Faces::corners()
  Clusters clusters;                // of its vertices (without their cover)
  std::vector<std::uint8_t> holes;  // one flag a halfedge
  std::vector<Index> lines;         // one an edge, or no_index
};

}  // namespace meshgrain
