// The stages of the pipeline from the fields to the faces.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "border/lock_borders.h"
#include "extract/add_strips.h"
#include "extract/remove_strips.h"
#include "extract/single_faces.h"
#include "features/cut_samples.h"
#include "field/transfer.h"
#include "finish/smooth.h"
#include "finish/untwist.h"
#include "measure/face_shape.h"
#include "mesh/border.h"
#include "meshgrain/error.h"
#include "remesh/close_bad_quads.h"
#include "remesh/count_search.h"
#include "remesh/pipeline.h"
#include "remesh/untie_knots.h"

namespace meshgrain {
namespace {

/// How far a count may be off after strips have gone or come, which are long: all that may be.
constexpr double strip_tolerance = 0.0099;

/// A number of faces; none if it is negative.
std::size_t rounded_up(double faces) {
  return static_cast<std::size_t>(std::ceil(std::max(0.0, faces)));
}

/// Pairs of neighbouring faces that both touch the border.
std::vector<std::array<Index, 2>> border_of_faces(const Mesh& surface, const Graph& graph,
                                                  const Context& context) {
  const auto on_border = mark_ends(border_edges(surface, context), surface.positions.size());
  const auto touches = [&](Index f) {
    const auto face = surface.faces[f];
    return on_border[face[0]] || on_border[face[1]] || on_border[face[2]];
  };
  std::vector<std::array<Index, 2>> result;
  for (Index f = 0; f < graph.size(); ++f) {
    for (const Index g : graph.neighbors_of(f)) {
      if (f < g && touches(f) && touches(g)) result.push_back({f, g});
    }
  }
  return result;
}

}  // namespace

void Pipeline::position_and_extract() {
  find_faces();
  if (made_.extraction.mesh.faces.empty()) {
    throw Error(
        "nothing is left of the surface at this target: ask for more faces, or shorter edges");
  }
}

void Pipeline::find_faces() {
  constexpr int attempts = 8;
  const double tolerance = plan_.target.tolerance();
  const bool given = has_given_positions(options_);
  double least_error = std::numeric_limits<double>::infinity();
  bool has_room = true;       // beside borders that stay
  bool is_changeable = true;  // whether faces can be taken away or added, as far as is known
  CountSearch search;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    complete_levels();
    FacesMade found;
    stage_("position field", [&] {
      if (!given) return solve_positions(found);
      found.position = FieldTransfer(*options_.fields, graph(), frame_, context_).position();
    });
    // Another attempt is unlikely then.
    if (!plan_.target.must_be_met()) drop_coarse_levels();
    found.extraction = stage_("extraction", [&] { return extract(found.position); });
    const double ratio = plan_.target.count_ratio(found.extraction.mesh);
    const double closing = attempt < 3 ? surplus() : std::max(surplus(), 0.03);
    const bool met = std::abs(ratio - 1) < tolerance ||
                     (ratio > 1 && ratio < 1 + closing && !given && take_faces_away(found)) ||
                     (ratio < 1 && ratio > 1 - surplus() && !given && add_faces(found));
    const double error = met ? 0 : ratio < 1 ? 1 / ratio - 1 : (ratio - 1) / 5;
    if (error < least_error) {
      least_error = error;
      made_ = std::move(found);
    }
    if (given || met) break;
    const bool is_near = ratio < 1 + closing && ratio > 1 - surplus();
    is_changeable = is_changeable && !is_near;
    const double before = search.asked();
    search.go_on(ratio, !is_changeable ? 1 : attempt < 3 ? count_to_aim_at() : 1.01);
    if (search.is_in_vain()) break;
    const double more = search.asked() - before;
    if (!plan_.borders.empty()) {
      has_room = fit_lengths_to_borders(std::exp(more));
      if (!has_room) break;
    } else {
      plan_.lengths =
          graded(graph(), scaled(plan_.lengths, std::exp(-more / 2)), growth(), context_);
    }
  }
  if (!has_room || made_.is_split) return;
  const double ratio = plan_.target.count_ratio(made_.extraction.mesh);
  const double most_to_change = given ? 1 + plan_.target.surplus() : 2;
  if (ratio > 1 + tolerance && ratio < most_to_change && !take_faces_away(made_)) {
    stage_("extraction", [&] { take_strips(made_, made_.extraction.mesh.faces.corners().size()); });
  }
  if (ratio < 1 - tolerance && ratio > 1 / most_to_change) add_single_faces();
}

bool Pipeline::take_faces_away(FacesMade& made) {
  return stage_("extraction", [&] {
    Extraction& extraction = made.extraction;
    // Single quads beside strips, if these are fewer than the larger ones from before the split.
    const std::size_t larger = plan_.target.faces_to_close(extraction.mesh, strip_tolerance);
    if (take_strips(made, larger)) return true;
    const std::size_t wanted =
        plan_.target.faces_to_close(extraction.mesh, plan_.target.tolerance());
    return remove_single_faces(extraction, posy_of(options_.faces), wanted, context_) >= wanted;
  });
}

bool Pipeline::add_faces(FacesMade& made) {
  return change_quads(made, [&](Extraction& quads, double count, double wanted) {
    // A row more is much where faces are large for what they cover: another attempt is better.
    if (quads.mesh.faces.size() < few_faces) return false;
    const std::size_t least = rounded_up((1 - strip_tolerance) * wanted - count);
    const auto most = static_cast<std::size_t>((1 + strip_tolerance) * wanted - count);
    return stage_("extraction", [&] { return add_strips(quads, least, most, context_) >= least; });
  });
}

void Pipeline::add_single_faces() {
  if (posy_of(options_.faces) != 4) return;
  stage_("extraction", [&] {
    const std::size_t missing = plan_.target.missing_quads(made_.extraction.mesh);
    if (plan_.lattice_faces == OutputFaces::quads) {
      split(made_.extraction);
      made_.is_split = true;
    }
    add_single_quads(made_.extraction, missing, context_);
  });
}

bool Pipeline::take_strips(FacesMade& made, std::size_t most_single) {
  return change_quads(made, [&](Extraction& quads, double count, double wanted) {
    const std::size_t least = rounded_up(count - (1 + strip_tolerance) * wanted);
    const auto most = static_cast<std::size_t>(count - (1 - strip_tolerance) * wanted);
    const std::size_t gone = remove_strips(quads, least, most, context_);
    if (gone >= least) return true;
    const std::size_t rest = least - gone;
    return rest <= most_single &&
           remove_single_faces(quads, posy_of(options_.faces), rest, context_) >= rest;
  });
}

template <typename Change>
bool Pipeline::change_quads(FacesMade& made, const Change& change) {
  if (options_.faces != OutputFaces::quads) return false;
  Extraction quads = made.extraction;
  if (plan_.lattice_faces == OutputFaces::quads) split(quads);
  const auto count = static_cast<double>(quads.mesh.faces.size());
  if (!change(quads, count, count / plan_.target.count_ratio(made.extraction.mesh))) return false;
  made.extraction = std::move(quads);
  made.is_split = true;
  return true;
}

double Pipeline::surplus() const {
  const bool guided =
      std::ranges::any_of(options_.guides, [](const Guide& guide) { return guide.strength > 0; });
  const bool harmless =
      plan_.lengths.uniform() && !guided && plan_.borders.empty() && regularity_ < 1;
  return harmless ? plan_.target.surplus() : plan_.target.tolerance();
}

double Pipeline::count_to_aim_at() const {
  return 1 + (surplus() - plan_.target.tolerance()) / 2;
}

void Pipeline::solve_positions(FacesMade& made) const {
  PositionOptions position;
  static_cast<SolverOptions&>(position) = options_.solver;
  position.seed += plan_.other_start;
  position.posy = posy_of(options_.faces);
  position.energy = options_.position_energy;
  std::vector<PositionConstraint> constraints = plan_.constraints.position;
  const auto at_cuts = sample_cuts(cuts_, surface_, plan_.features, plan_.lengths);
  constraints.insert(constraints.end(), at_cuts.begin(), at_cuts.end());
  const auto solver = PositionSolver::create(hierarchy_, plan_.orientation, plan_.lengths, position,
                                             constraints, context_);
  while (solver->step(context_)) context_.progress("position field", solver->progress());
  made.position_energies = solver->energies();
  made.position = solver->field();
  // Where these are farther apart than lattice points are, others than they may lie nearer to nodes
  // half way between them.
  for (const PositionConstraint& sample : at_cuts) made.position.points[sample.node] = sample.point;
}

double Pipeline::cancelling_cost(double regularity) const {
  const double middle = plan_.lattice_faces == OutputFaces::quads           ? 9.3
                        : plan_.lattice_faces == OutputFaces::quad_dominant ? 14.3
                                                                            : 11.2;
  // Dearer ways crumple the grid, and mending it takes as many irregular vertices as they save.
  constexpr double least = 0.28, most = 4;  // of that
  const double growing = least + (1 - least) * regularity / std::max(1 - regularity, 1e-9);
  return middle * std::min(growing, most);
}

Extraction Pipeline::extract(const PositionField& positions) {
  ExtractOptions extract;
  extract.energy = options_.position_energy;
  extract.manifold = options_.manifold;
  // Sizes that vary need the dislocations where rows end.
  extract.cancelling_cost_where_graded = cancelling_cost(regularity_ / 5);
  extract.cancelling_cost = options_.sizing.is_uniform() ? cancelling_cost(regularity_)
                                                         : extract.cancelling_cost_where_graded;
  if (is_cloud_) {
    extract.largest_filled_gap = 12;  // a larger one may well be a hole
    extract.border = border_edges(graph(), cloud_border_);
  } else if (nodes_are_vertices_) {
    extract.surface = &surface_;
    extract.features = &plan_.features;
    extract.sources = cuts_.sources;
    extract.only_quads = has_quads_alone();
    extract.keeps_singularities = plan_.keeps_singularities;
    // See finish_borders(); and hexagons around a vertex of several pieces would be open.
    extract.manifold = options_.manifold || !plan_.borders.empty() ||
                       (options_.faces == OutputFaces::hexagons && !cuts_.empty());
  } else {
    extract.border = border_of_faces(surface_, graph(), context_);
  }
  Extraction found = extract_mesh(graph(), plan_.orientation, positions, extract, context_);
  if (!nodes_are_vertices_) {
    for (Index& node : found.nodes) node = std::as_const(surface_.faces)[node][0];
  }
  if (options_.manifold) make_manifold(found);
  if (!plan_.borders.empty()) lock_borders(found, plan_.borders, graph(), options_.faces, context_);
  if (options_.faces == OutputFaces::hexagons) take_dual(found);
  return found;
}

void Pipeline::split(Extraction& extraction) const {
  split_into_quads(extraction);
  if (!plan_.borders.empty()) lock_middles(extraction, plan_.borders, graph());
}

SmoothOptions Pipeline::smooth_options() const {
  SmoothOptions smoothing;
  smoothing.iterations = options_.smoothing;
  if (has_thin_limbs_) smoothing.slow_start = 12;
  // The more regular, the more the grid must stretch. Triangles of one size are regular; the
  // triangles among quads are smaller than these.
  if (options_.faces == OutputFaces::quads) {
    smoothing.evenness = 0.61 + 0.12 * regularity_;
  }
  if (options_.faces == OutputFaces::triangles) smoothing.evenness = 0.8;
  if (options_.faces == OutputFaces::quad_dominant) smoothing.evenness = 0.48;
  const EdgeLength& lengths = made_.position.edge_length;
  if (!lengths.uniform() && nodes_are_vertices_) smoothing.relative_size = lengths;
  smoothing.fit = options_.sizing.adaptive;
  smoothing.corners_stay = !plan_.borders.empty();
  // Quads at lines are mended by close_bad_quads() first.
  smoothing.creases_stay = posy_of(options_.faces) == 4;
  if (!is_cloud_) smoothing.features = nodes_are_vertices_ ? &plan_.features : &border_lines_;
  return smoothing;
}

bool Pipeline::smooth_faces_if(const std::function<bool()>& is_worth_mending) {
  return stage_("smoothing", [&] {
    if (plan_.lattice_faces == OutputFaces::quads && !made_.is_split) {
      split(made_.extraction);
      made_.is_split = true;
    }
    finish_borders();
    SmoothOptions smoothing = smooth_options();
    if (!smooth(made_.extraction, surface_, around_, finishing_graph(), smoothing, context_,
                is_worth_mending)) {
      return false;
    }
    // What is bad beside vertices that cannot move shows only now.
    if (!plan_.borders.empty() &&
        improve_border_faces(made_.extraction, options_.faces, context_)) {
      smooth(made_.extraction, surface_, around_, finishing_graph(), smoothing, context_);
    }
    if (options_.smoothing > 0 && posy_of(options_.faces) == 4) {
      close_bad_quads(made_.extraction, surface_, around_, finishing_graph(), std::move(smoothing),
                      plan_.target.spare_faces(made_.extraction.mesh), context_);
    }
    return true;
  });
}

void Pipeline::finish_borders() {
  if (plan_.borders.empty()) return;
  if (options_.faces == OutputFaces::quads) {
    drop_spare_middles(made_.extraction);
    improve_border_faces(made_.extraction, options_.faces, context_);
  }
  // The pieces of a surface that is not manifold were kept apart, so that each had its own borders.
  if (!options_.manifold) join_locked(made_.extraction);
}

void Pipeline::untwist_faces() {
  if (options_.smoothing == 0 || options_.faces == OutputFaces::hexagons) return;
  const bool border_stays = keeps_border_ || !plan_.borders.empty();
  stage_("smoothing",
         [&] { untwist(made_.extraction, finishing_graph().normals, border_stays, context_); });
}

void Pipeline::untie_knots() {
  if (options_.faces != OutputFaces::quads || !plan_.borders.empty() || !shows_faults()) return;
  // Shape is what regularity may cost.
  const auto most_worse = static_cast<float>(1 + regularity_ / 2);
  stage_("smoothing", [&] {
    meshgrain::untie_knots(made_.extraction, surface_, around_, finishing_graph(), smooth_options(),
                           plan_.target.spare_faces(made_.extraction.mesh), most_worse, context_);
  });
}

}  // namespace meshgrain
