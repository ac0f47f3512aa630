#pragma once

#include <span>
#include <vector>

#include "features/trace_guides.h"
#include "meshgrain/context.h"

namespace meshgrain {

/// Where guides run on a surface that they were cut into.
struct GuideLines {
  struct Vertex {
    Index vertex;
    Vec3 position;   ///< Of the guide: hardly beside the vertex.
    Vec3 direction;  ///< Of the guide; zero where several meet.
  };
  std::vector<EdgeOfLine> edges;  ///< Each once.
  std::vector<Vertex> vertices;   ///< Of these edges, in increasing order.
};

/// Cuts guides into a triangle mesh, which stays the same surface: where they cross an edge that is
/// split, and its faces with it, unless a vertex is so near that it does as well.
GuideLines cut_guides(Mesh& surface, std::span<const GuideRun> runs, const Context& context);

/// Follows a change of the order of vertices: `order` has the old index of each new one.
void renumber(GuideLines& lines, std::span<const Index> order);

}  // namespace meshgrain
