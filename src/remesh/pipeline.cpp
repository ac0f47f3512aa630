#include "remesh/pipeline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "border/lock_borders.h"
#include "extract/add_strips.h"
#include "extract/remove_strips.h"
#include "extract/single_faces.h"
#include "features/lines_abreast.h"
#include "field/bend_alignment.h"
#include "field/transfer.h"
#include "finish/crossings.h"
#include "finish/face_shape.h"
#include "finish/smooth.h"
#include "finish/untwist.h"
#include "graph/vertex_graph.h"
#include "mesh/border.h"
#include "meshgrain/error.h"
#include "meshgrain/singularities.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "remesh/close_bad_quads.h"
#include "remesh/count_search.h"
#include "remesh/flattened_share.h"
#include "remesh/holes_and_pieces.h"
#include "remesh/notes.h"

namespace meshgrain {
namespace {

/// How far a count may be off after strips have gone or come, which are long: all that may be.
constexpr double strip_tolerance = 0.0099;

/// Pairs of neighbouring faces that both touch the border.
std::vector<std::array<Index, 2>> border_of_faces(const Mesh& surface, const Graph& graph) {
  std::vector<std::uint8_t> on_border(surface.positions.size(), 0);
  for (const auto& [a, b] : border_edges(surface)) on_border[a] = on_border[b] = 1;
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

Pipeline::Pipeline(const Mesh& input, const RemeshOptions& options, const Context& context)
    : options_(options),
      context_(context),
      stage_(context, result_.report.stages),
      is_cloud_(input.is_point_cloud()),
      nodes_are_vertices_(is_cloud_ || options.graph.nodes == GraphNodes::vertices),
      wanted_(options),
      regularity_(options.regularity) {
  result_.report.input_vertices = input.positions.size();
  result_.report.input_faces = input.faces.size();
  if (options.lock_borders && is_cloud_) {
    throw Error("borders of a mesh can be locked: the input is a point cloud, which has none");
  }
}

void Pipeline::build_graph() {
  hierarchy_ = {};
  hierarchy_.levels.push_back(stage_("graph", [&] {
    around_ = is_cloud_ ? VertexFaces() : vertex_faces(surface_, context_);
    return !is_cloud_ && nodes_are_vertices_
               ? vertex_graph(surface_, around_, options_.graph, context_)
               : meshgrain::build_graph(surface_, options_.graph, context_);
  }));
  result_.report.nodes = graph().size();
  result_.report.edges = graph().neighbors.size() / 2;
}

void Pipeline::build_levels() {
  stage_("hierarchy",
         [&] { hierarchy_ = build_hierarchy(std::move(hierarchy_.levels[0]), context_); });
  result_.report.levels = hierarchy_.levels.size();
}

void Pipeline::complete_levels() {
  if (hierarchy_.levels.size() < result_.report.levels) build_levels();
}

void Pipeline::drop_coarse_levels() {
  hierarchy_.levels.resize(1);
  hierarchy_.parents = {};
  hierarchy_.children = {};
  hierarchy_.colorings = {};
}

void Pipeline::find_lines() {
  area_ = 0;
  for (const float a : graph().areas) area_ += a;
  if (is_cloud_) {
    soft_guides_.clear();
    lay_guides(mean_length());
  }
  constraints_ = guide_constraints(graph(), soft_guides_);
  if (is_cloud_ || !nodes_are_vertices_) return;
  if (options_.lock_borders) borders_ = find_border_loops(surface_, locked_, context_);
  stage_("features", [&] {
    FeatureOptions options = feature_options();
    if (options_.orientation_energy != OrientationEnergy::extrinsic) options.orient_creases = 1;
    // Triangles cannot follow two creases that meet at right angles.
    if (posy_of(options_.faces) == 6) options.align_creases = 0.3f;
    features_ = find_features(surface_, options, guides_, target_.face_side(area_), context_);
    append(feature_constraints(features_));
    append(guide_constraints(guides_, features_.corners));
  });
}

bool Pipeline::is_coarse_for_bends() const {
  // Both were measured: beyond them the finer lattice only has more singularities.
  constexpr double most_faces = 1500, little_bent = 0.945;
  return area_ < most_faces * target_.face_area(area_) &&
         flattened_share(hierarchy_, 2 * std::pow(mean_length(), 2), context_) < little_bent;
}

double Pipeline::share_of_holes() const {
  return meshgrain::share_of_holes(graph(), surface_.faces.size(), area_ / target_.face_area(area_),
                                   context_);
}

bool Pipeline::choose_lattice() {
  const bool free = options_.fine_lattice && options_.guides.empty() &&
                    options_.fields == nullptr && borders_.empty();
  if (options_.faces != OutputFaces::quads || is_cloud_ || !nodes_are_vertices_ || !free) {
    return false;
  }
  // A cell of the coarse lattice is two faces wide. Which shares was measured.
  const double side = target_.face_side(area_);
  const auto many_abreast = [&](std::span<const std::uint8_t> on_border) {
    return share_abreast(features_, on_border, 1.5 * side) > 0.25 ||
           share_abreast(features_, on_border, 2 * side) > 0.6;
  };
  has_thin_limbs_ = is_coarse_for_bends();
  // Among more faces holes are little to see, for twice the time and the memory.
  constexpr double most_faces = 30000, little = 0.1;
  const bool any = has_thin_limbs_ ||
                   (area_ < most_faces * target_.face_area(area_) && share_of_holes() > little);
  if (!any && !many_abreast({})) return false;  // nor are there without the borders
  const auto border = border_edges(surface_, context_);
  // Where more than two faces meet, all of them would have to get the same new vertices.
  if (rim_edges(surface_, context_).size() != border.size()) return false;
  std::vector<std::uint8_t> on_border(surface_.positions.size(), 0);
  for (const auto& [a, b] : border) on_border[a] = on_border[b] = 1;
  if (!any && !many_abreast(on_border)) return false;
  aim_at(OutputFaces::quad_dominant);
  return true;
}

void Pipeline::refine_for_details() {
  if (!choose_lattice()) return;
  const bool any_split = stage_(
      "subdivide", [&] { return split_long_edges(area_, edge_lengths(surface_, context_)); });
  if (!any_split) return;
  stage_("order", [&] { put_in_order(); });
  build_graph();
  find_lines();
  build_levels();
}

void Pipeline::size_faces() {
  Sizing sizing = options_.sizing;
  sizing.point = frame_.inside(sizing.point);
  const EdgeLength relative = relative_edge_lengths(hierarchy_, surface_, features_, sizing,
                                                    target_.face_side(area_), context_);
  lengths_ = target_.edge_lengths(graph(), relative, growth(), context_);
  const double more_faces = faces_to_ask_for();
  if (borders_.empty()) {
    lengths_ = scaled(lengths_, std::sqrt(1 / more_faces));
    return;
  }
  free_lengths_ = lengths_;
  // The lattice of pure quads is twice as coarse as their edges.
  const double sides = options_.faces == OutputFaces::quads ? 2 : 1;
  border_spacing_ = border_spacing(borders_, graph(), mean_length(), sides, context_);
  fit_lengths_to_borders(more_faces);
}

bool Pipeline::has_quads_alone() const {
  return options_.faces == OutputFaces::quads && lattice_faces_ != options_.faces;
}

double Pipeline::surplus() const {
  const bool guided =
      std::ranges::any_of(options_.guides, [](const Guide& guide) { return guide.strength > 0; });
  const bool harmless = lengths_.uniform() && !guided && borders_.empty() && regularity_ < 1;
  return harmless ? target_.surplus() : target_.tolerance();
}

double Pipeline::count_to_aim_at() const {
  return 1 + (surplus() - target_.tolerance()) / 2;
}

double Pipeline::faces_to_ask_for() const {
  if (options_.edge_length > 0) return 1;
  // A lattice spans what bends within a few cells, as its faces will. How many was measured.
  const double cells = lattice_faces_ == OutputFaces::quads           ? 2
                       : lattice_faces_ == OutputFaces::quad_dominant ? 3
                                                                      : 4;
  // Where its odd faces become quads there are more of these than cells. By how much was measured.
  const double faces_a_cell = has_quads_alone() ? 1.1 : 1;
  const double left = flattened_share(hierarchy_, cells * std::pow(mean_length(), 2), context_);
  return count_to_aim_at() / (faces_a_cell * left);
}

bool Pipeline::fit_lengths_to_borders(double more_faces) {
  const double cells = std::pow(length_for_count(graph(), lengths_, 1, 1), 2) * more_faces;
  const auto fit = [&](double factor) {
    const EdgeLength lengths =
        fit_to_borders(scaled(free_lengths_, factor), border_spacing_, growth());
    lengths_ = graded(graph(), lengths, growth(), context_);
    return length_for_count(graph(), lengths_, 1, cells);
  };
  if (options_.edge_length > 0) {
    fit(1);
    return true;
  }
  // Bisection, as there are never more faces with longer edges. Where the border takes all that are
  // wanted, others must not be so large that nothing is left of the shape.
  constexpr int rounds = 14;
  constexpr double near_enough = 0.002;
  constexpr double least = 1.0 / 16, most = 3;
  double low = least, high = most;
  for (int round = 0; round < rounds; ++round) {
    const double factor = round == 0 ? 1 : std::sqrt(low * high);
    const double missing = fit(factor);
    if (std::abs(missing - 1) < near_enough) return true;
    (missing > 1 ? low : high) = factor;
  }
  return low > least && high < most;
}

void Pipeline::refine_for_sizes() {
  if (is_cloud_ || splits_only_once(options_) || lengths_.uniform()) return;
  std::vector<float> longest = scaled(lengths_, 0.5).values;
  if (!stage_("subdivide", [&] { return subdivide(surface_, longest, context_); })) return;
  stage_("order", [&] {
    const std::vector<Index> order = put_in_order();
    lengths_.values.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) lengths_.values[i] = 2 * longest[order[i]];
  });
  build_graph();
  find_lines();
  build_levels();
  if (!borders_.empty()) return size_faces();
  lengths_ = graded(graph(), lengths_, growth(), context_);
}

void Pipeline::orient() {
  stage_("orientation field", [&] {
    if (options_.fields != nullptr) {
      fields().orientation = transfer_orientation(*options_.fields, graph(), frame_, context_);
      return;
    }
    OrientationOptions orientation;
    static_cast<SolverOptions&>(orientation) = options_.solver;
    orientation.rosy = options_.rosy != 0 ? options_.rosy : posy_of(options_.faces);
    orientation.energy = options_.orientation_energy;
    const auto edge_length = static_cast<float>(mean_length());
    // An axis has no sign, which a field of arrows needs.
    const float bends = orientation.rosy == 1 ? 0 : options_.curvature.bends;
    auto constraints =
        bend_constraints(hierarchy_, surface_, around_, features_, edge_length, bends, context_);
    const auto curvature =
        curvature_constraints(graph(), edge_length, options_.curvature, context_);
    constraints.insert(constraints.end(), curvature.begin(), curvature.end());
    constraints.insert(constraints.end(), constraints_.orientation.begin(),
                       constraints_.orientation.end());
    const auto solver = OrientationSolver::create(hierarchy_, orientation, constraints);
    while (solver->step(context_)) context_.progress("orientation field", solver->progress());
    fields().orientation = solver->field();
    result_.report.orientation_energies = solver->energies();
  });
}

void Pipeline::position_and_extract() {
  find_faces();
  if (extraction_.mesh.faces.empty()) {
    throw Error(
        "nothing is left of the surface at this target: ask for more faces, or shorter edges");
  }
}

void Pipeline::find_faces() {
  constexpr int attempts = 8;
  const double tolerance = target_.tolerance();
  const bool given = has_given_positions(options_);
  double least_error = std::numeric_limits<double>::infinity();
  bool has_room = true;       // beside borders that stay
  bool is_changeable = true;  // whether faces can be taken away or added, as far as is known
  CountSearch search;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    complete_levels();
    PositionField positions = stage_("position field", [&] {
      return given ? transfer_position(*options_.fields, graph(), frame_, context_)
                   : solve_positions();
    });
    // Another attempt is unlikely then.
    if (!target_.must_be_met()) drop_coarse_levels();
    Extraction found = stage_("extraction", [&] { return extract(positions); });
    const double ratio = target_.count_ratio(found.mesh);
    const double closing = attempt < 3 ? surplus() : std::max(surplus(), 0.03);
    const bool met = std::abs(ratio - 1) < tolerance ||
                     (ratio > 1 && ratio < 1 + closing && !given && take_faces_away(found)) ||
                     (ratio < 1 && ratio > 1 - surplus() && !given && add_faces(found));
    const double error = met ? 0 : ratio < 1 ? 1 / ratio - 1 : (ratio - 1) / 5;
    if (error < least_error) {
      least_error = error;
      extraction_ = std::move(found);
      fields().position = std::move(positions);
    }
    if (given || met) break;
    const bool is_near = ratio < 1 + closing && ratio > 1 - surplus();
    is_changeable = is_changeable && !is_near;
    const double before = search.asked();
    search.go_on(ratio, !is_changeable ? 1 : attempt < 3 ? count_to_aim_at() : 1.01);
    const double more = search.asked() - before;
    if (!borders_.empty()) {
      has_room = fit_lengths_to_borders(std::exp(more));
      if (!has_room) break;
    } else {
      lengths_ = graded(graph(), scaled(lengths_, std::exp(-more / 2)), growth(), context_);
    }
  }
  if (!has_room || is_split_) return;
  const double ratio = target_.count_ratio(extraction_.mesh);
  const double most_to_change = given ? 1 + target_.surplus() : 2;
  if (ratio > 1 + tolerance && ratio < most_to_change && !take_faces_away(extraction_)) {
    stage_("extraction",
           [&] { take_strips(extraction_, extraction_.mesh.faces.corners().size()); });
  }
  if (ratio < 1 - tolerance && ratio > 1 / most_to_change) add_single_faces();
}

bool Pipeline::take_faces_away(Extraction& extraction) {
  return stage_("extraction", [&] {
    // Single quads beside strips, if these are fewer than the larger ones from before the split.
    const std::size_t larger = target_.faces_to_close(extraction.mesh, strip_tolerance);
    if (take_strips(extraction, larger)) return true;
    const std::size_t wanted = target_.faces_to_close(extraction.mesh, target_.tolerance());
    return remove_single_faces(extraction, posy_of(options_.faces), wanted, context_) >= wanted;
  });
}

bool Pipeline::add_faces(Extraction& extraction) {
  return change_quads(extraction, [&](Extraction& quads, double count, double wanted) {
    // A row more is much where faces are large for what they cover: another attempt is better.
    if (quads.mesh.faces.size() < few_faces) return false;
    const auto least = static_cast<std::size_t>(std::ceil((1 - strip_tolerance) * wanted - count));
    const auto most = static_cast<std::size_t>((1 + strip_tolerance) * wanted - count);
    return stage_("extraction", [&] { return add_strips(quads, least, most, context_) >= least; });
  });
}

void Pipeline::add_single_faces() {
  if (posy_of(options_.faces) != 4) return;
  stage_("extraction", [&] {
    const std::size_t missing = target_.missing_quads(extraction_.mesh);
    if (lattice_faces_ == OutputFaces::quads) {
      split(extraction_);
      is_split_ = true;
    }
    add_single_quads(extraction_, missing, context_);
  });
}

bool Pipeline::take_strips(Extraction& extraction, std::size_t most_single) {
  return change_quads(extraction, [&](Extraction& quads, double count, double wanted) {
    const auto least = static_cast<std::size_t>(std::ceil(count - (1 + strip_tolerance) * wanted));
    const auto most = static_cast<std::size_t>(count - (1 - strip_tolerance) * wanted);
    const std::size_t gone = remove_strips(quads, least, most, context_);
    if (gone >= least) return true;
    const std::size_t rest = least - gone;
    return rest <= most_single &&
           remove_single_faces(quads, posy_of(options_.faces), rest, context_) >= rest;
  });
}

template <typename Change>
bool Pipeline::change_quads(Extraction& extraction, const Change& change) {
  if (options_.faces != OutputFaces::quads) return false;
  Extraction quads = extraction;
  if (lattice_faces_ == OutputFaces::quads) split(quads);
  const auto count = static_cast<double>(quads.mesh.faces.size());
  if (!change(quads, count, count / target_.count_ratio(extraction.mesh))) return false;
  extraction = std::move(quads);
  is_split_ = true;
  return true;
}

void Pipeline::note_scraps() {
  constexpr std::ptrdiff_t many = 10;
  if (is_cloud_ || options_.min_component > 0) return;
  const double face = target_.face_area(area_);
  const auto scraps = std::ranges::count_if(piece_areas(graph(), context_),
                                            [&](double area) { return area < face; });
  if (scraps < many) return;
  result_.report.notes.push_back(std::to_string(scraps) +
                                 " pieces are smaller than a face, and take faces all the same: "
                                 "--min-component 1 leaves them out");
}

void Pipeline::report_fields() {
  result_.report.edge_length = fields().position.edge_length[0] * frame_.scale;
  if (!options_.count_singularities || is_cloud_ || !nodes_are_vertices_) return;
  stage_("singularities", [&] {
    result_.report.orientation_singularities =
        orientation_singularities(surface_, graph().normals, fields().orientation, context_).size();
    result_.report.position_singularities =
        position_singularities(surface_, graph(), fields().orientation, fields().position,
                               options_.position_energy, context_)
            .size();
  });
}

void Pipeline::smooth_faces() {
  stage_("smoothing", [&] {
    if (lattice_faces_ == OutputFaces::quads && !is_split_) split(extraction_);
    finish_borders();
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
    const EdgeLength& lengths = fields().position.edge_length;
    if (!lengths.uniform() && nodes_are_vertices_) smoothing.relative_size = lengths;
    smoothing.fit = options_.sizing.adaptive;
    smoothing.corners_stay = !borders_.empty();
    // Quads at lines are mended by close_bad_quads() first.
    smoothing.creases_stay = posy_of(options_.faces) == 4;
    if (!is_cloud_ && nodes_are_vertices_) smoothing.features = &features_;
    smooth(extraction_, surface_, around_, graph(), smoothing, context_);
    // What is bad beside vertices that cannot move shows only now.
    if (!borders_.empty() && improve_border_faces(extraction_, options_.faces, context_)) {
      smooth(extraction_, surface_, around_, graph(), smoothing, context_);
    }
    if (options_.smoothing > 0 && posy_of(options_.faces) == 4) {
      close_bad_quads(extraction_, surface_, around_, graph(), std::move(smoothing),
                      target_.spare_faces(extraction_.mesh), context_);
    }
  });
}

std::size_t Pipeline::inverted_faces() const {
  return mesh_statistics(extraction_.mesh).inverted_quads;
}

std::size_t Pipeline::faults() const {
  return inverted_faces() + find_crossings(extraction_.mesh, context_).size();
}

void Pipeline::try_coarser_lattice() {
  if (lattice_faces_ == options_.faces) return;
  constexpr double hopeless = 0.2;
  if (inverted_faces() == 0 || share_of_holes() > hopeless) return;
  const std::size_t before = faults();
  aim_at(options_.faces);
  try_again(before);
}

void Pipeline::try_less_regular() {
  const double moderate = RemeshOptions().regularity;
  if (is_cloud_ || options_.smoothing == 0 || regularity_ <= moderate) return;
  constexpr std::size_t hopeless = 20;  // one in so many faces
  const std::size_t before = faults();
  if (before == 0 || before > extraction_.mesh.faces.size() / hopeless) return;
  for (const double share : {0.5, 0.0}) {
    regularity_ = moderate + share * (options_.regularity - moderate);
    // Where the input passes through itself there are always some.
    if (!try_again(before / 2)) continue;
    result_.report.notes.push_back(
        "less regular than was asked for: faces would be inverted or pass through each other");
    break;
  }
  regularity_ = options_.regularity;
}

bool Pipeline::try_again(std::size_t too_many) {
  Extraction before = std::exchange(extraction_, {});
  PositionField positions = std::exchange(fields().position, {});
  auto energies = std::exchange(result_.report.position_energies, {});
  is_split_ = false;
  complete_levels();
  size_faces();
  find_faces();
  if (!extraction_.mesh.faces.empty()) {
    smooth_faces();
    untwist_faces();
    if (faults() < too_many) return true;
  }
  extraction_ = std::move(before);
  fields().position = std::move(positions);
  result_.report.position_energies = std::move(energies);
  return false;
}

void Pipeline::untwist_faces() {
  if (options_.smoothing == 0 || posy_of(options_.faces) != 4) return;
  stage_("smoothing", [&] { untwist(extraction_, graph().normals, context_); });
}

void Pipeline::aim_at(OutputFaces lattice_faces) {
  lattice_faces_ = lattice_faces;
  target_ = Target(wanted_, lattice_faces, clean_vertices_, frame_.scale);
}

void Pipeline::change_target(const RemeshOptions& options) {
  wanted_ = options;
  aim_at(options.faces);
  find_lines();
  choose_lattice();
  size_faces();
}

RemeshResult Pipeline::take_mesh(const RemeshReport& prepared) {
  RemeshResult level;
  level.mesh = std::move(extraction_.mesh);
  leave(frame_, level.mesh);
  level.report = std::exchange(result_.report, prepared);
  extraction_ = {};
  is_split_ = false;
  return level;
}

RemeshResult Pipeline::result() && {
  if (!nodes_are_vertices_) {  // the nodes are a cloud of their own
    surface_ = Mesh();
    surface_.positions = graph().positions;
  }
  fields().surface = std::move(surface_);
  fields().surface.normals = graph().normals;
  leave(frame_, fields());
  result_.mesh = std::move(extraction_.mesh);
  leave(frame_, result_.mesh);
  return std::move(result_);
}

void Pipeline::append(const FeatureConstraints& more) {
  constraints_.orientation.insert(constraints_.orientation.end(), more.orientation.begin(),
                                  more.orientation.end());
  constraints_.position.insert(constraints_.position.end(), more.position.begin(),
                               more.position.end());
}

void Pipeline::split(Extraction& extraction) const {
  split_into_quads(extraction);
  if (!borders_.empty()) lock_middles(extraction, borders_, graph());
}

void Pipeline::finish_borders() {
  if (borders_.empty()) return;
  if (options_.faces == OutputFaces::quads) {
    drop_spare_middles(extraction_);
    improve_border_faces(extraction_, options_.faces, context_);
    const Faces& faces = extraction_.mesh.faces;
    std::size_t triangles = 0;
    for (std::size_t f = 0; f < faces.size(); ++f) triangles += faces.degree(f) == 3;
    if (triangles > 0) {
      result_.report.notes.push_back(
          std::to_string(triangles) + (triangles == 1 ? " triangle" : " triangles") +
          ": a border of an odd number of edges cannot be met by quads alone");
    }
  }
  // The pieces of a surface that is not manifold were kept apart, so that each had its own borders.
  if (!options_.manifold) join_locked(extraction_);
}

PositionField Pipeline::solve_positions() {
  PositionOptions position;
  static_cast<SolverOptions&>(position) = options_.solver;
  position.posy = posy_of(options_.faces);
  position.energy = options_.position_energy;
  const auto solver = PositionSolver::create(hierarchy_, fields().orientation, lengths_, position,
                                             constraints_.position, context_);
  while (solver->step(context_)) context_.progress("position field", solver->progress());
  result_.report.position_energies = solver->energies();
  return solver->field();
}

double Pipeline::cancelling_cost(double regularity) const {
  const double middle = lattice_faces_ == OutputFaces::quads           ? 9.3
                        : lattice_faces_ == OutputFaces::quad_dominant ? 14.3
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
  } else if (nodes_are_vertices_) {
    extract.surface = &surface_;
    extract.features = &features_;
    extract.only_quads = has_quads_alone();
    extract.manifold = options_.manifold || !borders_.empty();  // see finish_borders()
  } else {
    extract.border = border_of_faces(surface_, graph());
  }
  Extraction found = extract_mesh(graph(), fields().orientation, positions, extract, context_);
  if (!nodes_are_vertices_) {
    for (Index& node : found.nodes) node = std::as_const(surface_.faces)[node][0];
  }
  if (options_.manifold) make_manifold(found);
  if (!borders_.empty()) lock_borders(found, borders_, graph(), options_.faces, context_);
  if (options_.faces == OutputFaces::hexagons) take_dual(found);
  return found;
}

}  // namespace meshgrain
