#include "remesh/try_more_faces.h"

#include <utility>

#include "meshgrain/statistics.h"

namespace meshgrain {

void try_more_faces(Made& made, const RemeshOptions& options, const Make& make,
                    const Context& context) {
  const bool is_whole = !made.result.fields.surface.is_point_cloud() && made.cuts.empty();
  const bool may_try = is_whole && may_remake(options) && options.edge_length == 0;
  if (!may_try || made.faults.inverted == 0) return;
  const Mesh surface = made.surface();
  if (!find_crossings(surface, context).empty()) return;
  Remaking remaking(made, options, make, context);
  const Made before = made;
  for (const std::size_t times : {2, 4}) {
    RemeshOptions more = remaking.options();
    more.face_count *= times;
    more.vertex_count *= times;
    Made other =
        remaking.made_of(surface, more, before, "made more faces: so few would be inverted");
    if (other.faults.inverted == 0 && remaking.keep_if_better(std::move(other))) return;
  }
}

}  // namespace meshgrain
