#pragma once

#include <vector>

#include "meshgrain/extract.h"
#include "meshgrain/graph.h"

namespace meshgrain {

/// A strip of faces between a border of a mesh and new vertices outside of it, both in the order in
/// which the halfedges of the hole go around.
struct Collar {
  std::vector<Index> inner;          ///< Vertices of the mesh.
  std::vector<double> inner_places;  ///< Where they are along the border.
  std::vector<Index> outer_nodes;    ///< Where the new vertices are on the surface.
  std::vector<double> outer_places;
  double period = 0;  ///< The length of the border in places.
};

/// Adds it, with quads where vertices are opposite to each other if `quads`, else of triangles. The
/// new vertices are corners that stay, the old ones are free.
void add_collar(Extraction& extraction, const Collar& collar, const Graph& graph, bool quads);

}  // namespace meshgrain
