#pragma once

#include <functional>

#include "mesh/vertex_faces.h"
#include "meshgrain/finish.h"

namespace meshgrain {

/// As in meshgrain/finish.h, where the faces around each vertex of the surface are known; of a
/// point cloud none are asked for. Most of the time may go into mending faces that are turned over:
/// if `is_worth_it` is given, and says of the mesh before that that it is not, all is left as it is
/// then, and false returned.
bool smooth(Extraction& extraction, const Mesh& surface, const VertexFaces& around_surface,
            const Graph& graph, const SmoothOptions& options, const Context& context,
            const std::function<bool()>& is_worth_it = {});

/// The last step of smooth() alone, from where the vertices are: mends faces that are turned over,
/// nearly degenerate, or pass through others.
void mend(Extraction& extraction, const Mesh& surface, const VertexFaces& around_surface,
          const Graph& graph, const SmoothOptions& options, const Context& context);

/// The same of the step after that, which smooth() leaves out where the mesh is only a part: faces
/// over thin parts and sharp bends are brought off other sides of the surface.
void keep_to_own_side(Extraction& extraction, const Mesh& surface,
                      const VertexFaces& around_surface, const Graph& graph,
                      const SmoothOptions& options, const Context& context);

}  // namespace meshgrain
