#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "extract/lattice_mesh.h"
#include "extract/lattice_repair.h"
#include "extract/mesh_clusters.h"
#include "meshgrain/features.h"
#include "meshgrain/hierarchy.h"

namespace meshgrain::made {

/// What extract_mesh() has when it begins to cancel position singularities. `keeps_singularities`:
/// of each vertex, see ExtractOptions.
inline LatticeMesh lattice(const Mesh& triangles, int posy, float edge_length,
                           std::span<const std::uint8_t> keeps_singularities = {}) {
  const Hierarchy hierarchy = build_hierarchy(build_graph(triangles));
  const Graph& graph = hierarchy.levels[0];
  OrientationOptions orientation_options;
  orientation_options.rosy = posy;
  PositionOptions position_options;
  position_options.posy = posy;
  const OrientationField orientation = solve_orientation(hierarchy, orientation_options);
  const PositionField position =
      solve_position(hierarchy, orientation, edge_length, position_options);
  CollapsedMesh collapsed =
      collapse_mesh(triangles, {}, find_features(triangles, {}, edge_length), graph, orientation,
                    position, position_options.energy, Context());
  LatticeMesh result(std::move(collapsed.lattice), std::move(collapsed.clusters), collapsed.roots,
                     graph, orientation, position, keeps_singularities);
  repair_lattice(result, Context());
  return result;
}

}  // namespace meshgrain::made
