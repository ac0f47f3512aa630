#include "remesh/try_joined_seams.h"

#include <fmt/format.h>

#include <utility>

#include "mesh/border.h"
#include "mesh/seams.h"
#include "mesh/weld.h"
#include "meshgrain/statistics.h"

namespace meshgrain {

Made made_without_seams(Remaking& remaking, Mesh surface, const Made& before) {
  const std::size_t merged = remaking.stage()("join seams", [&] { return weld(surface); });
  return remaking.made_of(std::move(surface), remaking.options(), before,
                          fmt::format("merged {} vertices along seams: faces of this size beside "
                                      "these would be inverted or pass through each other",
                                      merged));
}

void try_joined_seams(Made& made, const RemeshOptions& options, const Make& make,
                      const Context& context) {
  if (made.seamed.faces.empty()) return;
  // The two sides of a seam mostly cross a little, which is no fault of theirs, as they come from
  // one place. That alone is no reason to join them, unless there is little else to be seen. But
  // where they are all of the border, and no short slits, they are those of a closed surface.
  FaultCounts all = made.faults;
  all.crossings = find_crossings(made.result.mesh, context).size();
  const auto are_of_closed_surface = [&] {
    constexpr double short_loop = 12;  // sides of a face
    const auto border = border_edges(made.seamed, context);
    return find_seams(made.seamed, border).are_all() &&
           !has_short_loops(made.seamed, border, short_loop * made.side);
  };
  const bool are_bad = all.inverted > 0 || made.are_many(all.crossings);
  if (!are_bad && (all.are_hardly_any() || !are_of_closed_surface())) return;
  const std::size_t own = std::exchange(made.faults.crossings, all.crossings);
  bool is_better = false;
  try {
    Remaking remaking(made, options, make, context);
    is_better = remaking.keep_if_better(made_without_seams(remaking, made.seamed, made));
  } catch (...) {
    made.faults.crossings = own;
    throw;
  }
  if (!is_better) made.faults.crossings = own;
}

}  // namespace meshgrain
