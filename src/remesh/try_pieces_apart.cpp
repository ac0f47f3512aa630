#include "remesh/try_pieces_apart.h"

namespace meshgrain {

void try_pieces_apart(Made& made, const RemeshOptions& options, const Make& make,
                      const Context& context) {
  const bool may_part = may_remake(options) && !options.manifold && !made.cuts.empty();
  if (!may_part || made.faults.are_hardly_any()) return;
  Remaking remaking(made, options, make, context);
  remaking.keep_if_better(remaking.made_of(
      made.surface_in_pieces(), remaking.options(), made,
      "left pieces apart that meet where the surface is not manifold: faces of this size with the "
      "same vertices would be inverted or pass through each other"));
}

}  // namespace meshgrain
