#pragma once

#include "extract/face_repair.h"

namespace meshgrain {

/// The closed orbits as faces, and only the vertices that they use.
/// `vertex` gets the number of each cluster's vertex, or no_index.
Extraction collect_faces(const PolygonMap& map, const FaceRepair& repair, const Clusters& clusters,
                         std::vector<Index>& vertex, const Context& context);

}  // namespace meshgrain
