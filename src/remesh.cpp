#include "meshgrain/remesh.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>
#include <optional>
#include <utility>

#include "meshgrain/error.h"
#include "remesh/check_input.h"
#include "remesh/memory.h"
#include "remesh/notes.h"
#include "remesh/pipeline.h"
#include "remesh/target.h"
#include "remesh/try_finer_faces.h"
#include "remesh/try_joined_seams.h"
#include "remesh/try_more_faces.h"
#include "remesh/try_no_creases.h"
#include "remesh/try_pieces_apart.h"
#include "remesh/try_simpler_topology.h"
#include "sharpen/round_again.h"
#include "symmetry/remesh_symmetric.h"

namespace meshgrain {
namespace {

void check_given(const Fields& fields, int posy) {
  const int rosy = fields.orientation.rosy;
  const PositionField& position = fields.position;
  const bool has_positions = !position.points.empty();
  const std::size_t nodes = fields.surface.positions.size();
  const bool has_lengths =
      position.edge_length.uniform() || position.edge_length.values.size() == nodes;
  if (fields.orientation.directions.size() != nodes ||
      (has_positions && (position.points.size() != nodes || !has_lengths))) {
    throw Error("the given fields need a value at every vertex of their surface");
  }
  if (rosy < 1 || posy % rosy != 0) {
    throw Error("the given orientations have symmetry " + std::to_string(rosy) +
                ", which does not fit positions of symmetry " + std::to_string(posy));
  }
  if (has_positions && position.posy != posy) {
    throw Error("the given positions have symmetry " + std::to_string(position.posy) + ", not " +
                std::to_string(posy) + " as the faces that are asked for");
  }
}

void check(const RemeshOptions& options) {
  const int posy = posy_of(options.faces);
  if (options.fields != nullptr) check_given(*options.fields, posy);
  if (options.rosy != 0 && posy % options.rosy != 0) {
    throw Error("orientations of symmetry " + std::to_string(options.rosy) +
                " do not fit positions of symmetry " + std::to_string(posy) +
                ": use 1, 2 or 4 for quads, 1, 2 or 6 for triangles");
  }
  if (options.edge_length < 0 || !std::isfinite(options.edge_length)) {
    throw Error("the target edge length must be a positive number");
  }
  if (!(options.regularity >= 0 && options.regularity <= 1)) {
    throw Error("the regularity must lie between 0 and 1");
  }
  if (!(options.min_component >= 0) || !std::isfinite(options.min_component)) {
    throw Error("the least number of faces of a piece must not be negative");
  }
  if (options.graph.nodes == GraphNodes::faces && options.sizing.is_by_value()) {
    throw Error("sizes by value are those of the input's vertices, not of its faces");
  }
  check(options.sizing);
  const CurvatureAlignment& curvature = options.curvature;
  if (!(curvature.strength >= 0 && curvature.strength <= 1) ||
      !(curvature.bends >= 0 && curvature.bends <= 1) || !(curvature.hard_degrees >= 0)) {
    throw Error(
        "alignment to curvature and to bends must lie between 0 and 1, and no angle below 0");
  }
  if (options.graph.neighbors == 0) throw Error("points of a cloud need neighbours: one at least");
  if (options.smoothing < 0) throw Error("the number of smoothing iterations must not be negative");
  if (options.graph.nodes == GraphNodes::faces && options.symmetry.any()) {
    throw Error("results can be made symmetric over the input's vertices, not over its faces");
  }
  if (options.lock_borders && options.symmetry.any()) {
    throw Error("borders cannot be locked and the result made symmetric: leave one of them out");
  }
  if (options.lock_borders && options.faces == OutputFaces::hexagons) {
    throw Error("hexagons leave out the border, which cannot be locked then");
  }
  if (options.lock_borders && options.graph.nodes == GraphNodes::faces) {
    throw Error("borders can be locked over the input's vertices, not over its faces");
  }
  if (options.solver.sweeps < 0) throw Error("a number of sweeps cannot be negative");
}

/// All that does not depend on the number of faces, but as fine as the target needs it: what it
/// leaves can serve several meshes. The surface was cleaned up.
void prepare(Pipeline& pipeline) {
  pipeline.sharpen();
  pipeline.coarsen();
  pipeline.refine();
  pipeline.build_graph();
  pipeline.find_lines();
  pipeline.build_levels();
  pipeline.refine_for_details();
  pipeline.size_faces();
  pipeline.refine_for_sizes();
  pipeline.orient();
}

void make_mesh(Pipeline& pipeline) {
  do {
    pipeline.position_and_extract();
    pipeline.smooth_faces();
    pipeline.untwist_faces();
  } while (pipeline.mend_flaws());
  pipeline.try_coarser_lattice();
  pipeline.try_less_regular();
  if (!pipeline.is_of_use()) return;
  pipeline.untie_knots();
  pipeline.try_more_regular();
  pipeline.note_odd_borders();
  pipeline.note_scraps();
  pipeline.note_parted_hexagons();
  pipeline.report_fields();
}

Made make(Mesh input, const RemeshOptions& options, const std::optional<Wanted>& wanted,
          const Context& context) {
  Pipeline pipeline(input, options, context);
  if (wanted) pipeline.beat(wanted->fewer_than);
  if (wanted && wanted->with_creases) pipeline.keep_creases();
  pipeline.clean_up(std::move(input));
  Mesh seamed = may_remake(options) ? pipeline.seamed_surface() : Mesh();
  // Where faces beside seams are bad, it is better to join these than to bend them.
  if (!seamed.faces.empty()) pipeline.keep_border();
  prepare(pipeline);
  std::vector<std::string> notes = pipeline.report().notes;
  make_mesh(pipeline);
  Made made{.result = {},  // comes last
            .faults = pipeline.find_faults(),
            .side = pipeline.face_side(),
            .notes = std::move(notes),
            .seamed = std::move(seamed),
            .has_marks = pipeline.has_marks() || pipeline.is_sharpened(),
            .was_marked = pipeline.was_marked(),
            .roundings = pipeline.roundings(),
            .cuts = pipeline.cuts(),
            .room_for_creases = pipeline.room_for_creases()};
  made.follows_creases = made.faults.inverted > 0 && pipeline.follows_creases();
  made.result = std::move(pipeline).result();
  return made;
}

/// One half of a mesh, whose tunnels must be those of the other, and its border where they meet.
RemeshedHalf remesh_half(Mesh input, const RemeshOptions& options, const Context& context) {
  Pipeline pipeline(input, options, context);
  pipeline.keep_border();
  pipeline.clean_up(std::move(input));
  prepare(pipeline);
  make_mesh(pipeline);
  const FaultCounts faults = pipeline.find_faults();
  return {std::move(pipeline).result(), faults};
}

/// What cannot be made otherwise stays as it is.
template <typename Way>
void attempt(const Way& way, Made& made, const RemeshOptions& options, const Context& context) {
  try {
    way(made, options, make, context);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error&) {  // such as that nothing is left of another surface
  } catch (const std::bad_alloc&) {
  }
}

RemeshResult remesh_whole(Mesh input, const RemeshOptions& options, const Context& context) {
  Made made = make(std::move(input), options, std::nullopt, context);
  if (options.retries) {
    attempt(try_joined_seams, made, options, context);
    attempt(try_no_creases, made, options, context);
    attempt(try_finer_faces, made, options, context);
    attempt(try_simpler_topology, made, options, context);
    attempt(try_pieces_apart, made, options, context);
    attempt(try_more_faces, made, options, context);
  }
  round_again(made.result.mesh, made.roundings, context);
  note_faults(made.result, made.faults);
  return std::move(made.result);
}

}  // namespace

RemeshResult remesh(Mesh input, const RemeshOptions& asked, const Context& context) {
  check(asked);
  check_input(input, context);
  RemeshOptions options = asked;
  options.retries = check_memory(input, asked, context) && asked.retries;
  RemeshResult result = options.symmetry.any()
                            ? remesh_symmetric(std::move(input), options, remesh_half, context)
                            : remesh_whole(std::move(input), options, context);
  note_missed_count(result, options);
  return result;
}

std::vector<RemeshResult> remesh_levels(Mesh input, std::span<const std::size_t> face_counts,
                                        RemeshOptions options, const Context& context) {
  if (face_counts.empty() || *std::min_element(face_counts.begin(), face_counts.end()) == 0) {
    throw Error("levels need numbers of faces, all of them positive");
  }
  if (options.symmetry.any()) throw Error("several levels cannot be made symmetric");
  if (has_given_positions(options)) {
    throw Error("given positions decide how fine a mesh is, and make but one");
  }
  options.edge_length = 0;
  options.face_count = *std::max_element(face_counts.begin(), face_counts.end());
  check(options);
  check_input(input, context);
  options.retries = check_memory(input, options, context) && options.retries;
  Pipeline pipeline(input, options, context);
  pipeline.clean_up(std::move(input));
  prepare(pipeline);
  const RemeshReport prepared = pipeline.report();
  std::vector<std::size_t> order(face_counts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return face_counts[a] > face_counts[b]; });
  std::vector<RemeshResult> levels(face_counts.size());
  for (const std::size_t k : order) {
    RemeshOptions level = options;
    level.face_count = face_counts[k];
    if (k != order.front()) pipeline.change_target(level);
    make_mesh(pipeline);
    const Faults faults = pipeline.find_faults();
    levels[k] = pipeline.take_mesh(prepared);
    note_faults(levels[k], faults);
    note_missed_count(levels[k], level);
  }
  return levels;
}

}  // namespace meshgrain
