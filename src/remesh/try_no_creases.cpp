#include "remesh/try_no_creases.h"

namespace meshgrain {

void try_no_creases(Made& made, const RemeshOptions& options, const Make& make,
                    const Context& context) {
  if (!made.follows_creases || made.faults.inverted == 0 || !may_remake(options)) return;
  Remaking remaking(made, options, make, context);
  remaking.keep_if_better(remaking.made_without_creases(
      made.surface(), made,
      made.was_marked ? "without creases and marked edges: faces of this size that follow them "
                        "would be inverted"
                      : "without creases: faces of this size that follow them would be inverted"));
}

}  // namespace meshgrain
