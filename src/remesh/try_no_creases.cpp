#include "remesh/try_no_creases.h"

#include <utility>

namespace meshgrain {

void try_no_creases(Made& made, const RemeshOptions& options, const Make& make,
                    const Context& context) {
  if (!made.follows_creases || made.faults.inverted == 0 || !may_remake(options)) return;
  Remaking remaking(made, options, make, context);
  Mesh surface = made.result.fields.surface;
  if (!made.has_marks) surface.marked_edges.clear();  // those of creases that were found
  remaking.keep_if_better(remaking.made_without_creases(
      std::move(surface), made,
      made.has_marks ? "without creases and marked edges: faces of this size that follow them "
                       "would be inverted"
                     : "without creases: faces of this size that follow them would be inverted"));
  remaking.report_times();
}

}  // namespace meshgrain
