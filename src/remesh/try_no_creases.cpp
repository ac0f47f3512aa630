#include "remesh/try_no_creases.h"

#include <utility>

namespace meshgrain {

void try_no_creases(Made& made, const RemeshOptions& options, const Make& make,
                    const Context& context) {
  if (!made.is_without_some_creases || made.faults.inverted == 0 || !may_remake(options)) return;
  Remaking remaking(made, options, make, context);
  RemeshOptions without = remaking.options();
  without.features.creases = Creases::none;
  Made other =
      remaking.made_of(made.result.fields.surface, without, Made(made),
                       "without creases: faces of this size that follow them would be inverted");
  other.is_without_creases = true;
  remaking.keep_if_better(std::move(other));
  remaking.report_times();
}

}  // namespace meshgrain
