#include "remesh/try_no_creases.h"

#include <limits>
#include <utility>

namespace meshgrain {

void try_no_creases(Made& made, const RemeshOptions& options, const Make& make,
                    const Context& context) {
  if (!made.follows_creases || made.faults.inverted == 0 || !may_remake(options)) return;
  Remaking remaking(made, options, make, context);
  RemeshOptions without = remaking.options();
  without.features.creases = Creases::none;
  Mesh surface = made.result.fields.surface;
  if (!made.has_marks) surface.marked_edges.clear();  // those of creases that were found
  Made other = remaking.made_of(
      std::move(surface), without, made,
      made.has_marks ? "without creases and marked edges: faces of this size that follow them "
                       "would be inverted"
                     : "without creases: faces of this size that follow them would be inverted");
  other.follows_creases = false;
  other.room_for_creases = std::numeric_limits<double>::infinity();
  remaking.keep_if_better(std::move(other));
  remaking.report_times();
}

}  // namespace meshgrain
