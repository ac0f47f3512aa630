// The stages of the pipeline from the graph to the fields, and what is read off at the end.

#include "remesh/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "cloud/cloud_border.h"
#include "cloud/cloud_graph.h"
#include "cloud/fill_in.h"
#include "cloud/outliers.h"
#include "cloud/smooth_noise.h"
#include "features/askew_lines.h"
#include "features/cone_tips.h"
#include "features/lines_abreast.h"
#include "field/bend_alignment.h"
#include "field/transfer.h"
#include "graph/vertex_graph.h"
#include "mesh/border.h"
#include "meshgrain/error.h"
#include "meshgrain/singularities.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "remesh/flattened_share.h"
#include "remesh/holes_and_pieces.h"
#include "sharpen/round_again.h"

namespace meshgrain {

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
  has_all_levels_ = false;
  hierarchy_.levels.push_back(stage_("graph", [&] {
    cut_surface();
    if (is_cloud_) return graph_of_cloud();
    around_ = vertex_faces(surface_, context_);
    Graph of_vertices = vertex_graph(surface_, around_, options_.graph, context_);
    if (nodes_are_vertices_) return of_vertices;
    graph_of_vertices_ = std::move(of_vertices);
    return meshgrain::build_graph(surface_, options_.graph, context_);
  }));
  area_ = 0;
  for (const float a : graph().areas) area_ += a;
  result_.report.nodes = graph().size();
  result_.report.edges = graph().neighbors.size() / 2;
}

Graph Pipeline::graph_of_cloud() {
  Neighborhoods nearest = nearest_neighbors(surface_.positions, options_.graph.neighbors, context_);
  if (const std::size_t dropped = drop_outliers(surface_, nearest, context_)) {
    add_notes({fmt::format("left out {} {} far from all others", dropped,
                           dropped == 1 ? "point" : "points")});
  }
  if (smooth_noise(surface_, nearest, context_)) {
    add_notes({"smoothed the points, whose noise is larger than they are apart"});
  }
  const bool knows_sides = !surface_.normals.empty();
  const auto make_graph = [&] {
    if (knows_sides) leave_out_other_sides(nearest, surface_.normals, context_);
    return cloud_graph(surface_, nearest, options_.graph, context_);
  };
  Graph graph = make_graph();
  const double area = std::accumulate(graph.areas.begin(), graph.areas.end(), 0.0);
  plan_.target.refuse_too_many(area);
  surface_.normals = graph.normals;
  const auto apart = static_cast<float>(plan_.target.sparsest_points(options_, area));
  if (fill_in(surface_, nearest, apart, context_) > 0) graph = make_graph();
  return graph;
}

void Pipeline::cut_surface() {
  const bool may_cut = !is_cloud_ && nodes_are_vertices_ && !options_.lock_borders;
  if (may_cut && guides_.edges.empty()) cuts_ = cut_apart(surface_, context_);
}

void Pipeline::join_cuts() {
  inherent_crossings_.reset();
  join_again(surface_, std::exchange(cuts_, {}));
}

void Pipeline::build_levels() {
  stage_("hierarchy",
         [&] { hierarchy_ = build_hierarchy(std::move(hierarchy_.levels[0]), context_); });
  has_all_levels_ = true;
  result_.report.levels = hierarchy_.levels.size();
}

void Pipeline::complete_levels() {
  if (!has_all_levels_) build_levels();
}

void Pipeline::drop_coarse_levels() {
  hierarchy_.levels.resize(1);
  hierarchy_.parents = {};
  hierarchy_.children = {};
  hierarchy_.colorings = {};
  has_all_levels_ = false;
}

void Pipeline::find_borders() {
  plan_.borders = find_border_loops(surface_, locked_, context_);
  if (!plan_.divides_borders) return;
  const auto locked =
      locked_between(plan_.borders, surface_, locked_, plan_.target.face_side(area_));
  plan_.borders = find_border_loops(surface_, locked, context_);
}

void Pipeline::find_lines() {
  if (is_cloud_) {
    soft_guides_.clear();
    lay_guides(mean_length());
  }
  plan_.constraints = guide_constraints(graph(), soft_guides_);
  if (is_cloud_ && options_.features.align_border) {
    constexpr double faces_across = 2;  // smaller holes are filled
    stage_("features", [&] {
      const double smallest = faces_across * plan_.target.face_side(area_);
      cloud_border_ = cloud_border(graph(), static_cast<float>(smallest), context_);
    });
    append(border_constraints(cloud_border_));
  }
  if (is_cloud_) return;
  if (!nodes_are_vertices_) {
    const FeatureOptions border_alone{.creases = Creases::none, .align_border = false};
    border_lines_ = find_features(surface_, border_alone, 0, context_);
    return;
  }
  if (options_.lock_borders) find_borders();
  stage_("features", [&] {
    const auto find = [&] {
      FeatureOptions options = feature_options();
      if (options_.orientation_energy != OrientationEnergy::extrinsic) options.orient_creases = 1;
      // Triangles cannot follow two creases that meet at right angles.
      if (posy_of(options_.faces) == 6) options.align_creases = 0.3f;
      const double side = plan_.target.face_side(area_);
      plan_.features = find_features(surface_, options, guides_, cuts_.edges, side,
                                     plan_.room_for_creases * side, context_);
    };
    find();
    if (may_leave_out_creases() && lines_have_no_room()) {
      plan_.room_for_creases = no_creases;
      find();
      add_notes({fmt::format(
          "without creases{}: there are about as many of them as edges of faces of this size",
          was_marked() ? " and marked edges" : "")});
    }
    append(feature_constraints(plan_.features));
    keep_cone_tips();
    append(guide_constraints(guides_, plan_.features.corners));
  });
}

void Pipeline::keep_cone_tips() {
  if (feature_options().creases == Creases::none) return;
  const double side = plan_.target.face_side(area_);
  const auto tips = find_cone_tips(surface_, graph(), plan_.features, side, context_);
  std::vector<Index>& corners = plan_.features.corners;
  for (const Index v : tips) {
    corners.push_back(v);
    plan_.constraints.position.push_back({v, graph().positions[v], Vec3::Zero(), 1});
  }
  std::ranges::sort(corners);
}

bool Pipeline::may_leave_out_creases() const {
  return options_.features.creases == Creases::automatic && !leaves_out_creases() && !is_cloud_ &&
         nodes_are_vertices_;
}

bool Pipeline::has_marks() const {
  return is_coarsened_ ? had_marks_ : !surface_.marked_edges.empty();
}

double Pipeline::share_of_lines() const {
  double length = 0;
  for (std::size_t line = 0; line < plan_.features.size(); ++line) {
    for (Index k = plan_.features.begin(line) + 1; k < plan_.features.end(line); ++k) {
      length += (plan_.features.positions[k] - plan_.features.positions[k - 1]).norm();
    }
  }
  // A mesh of quads has twice as many edges as faces.
  return length * plan_.target.face_side(area_) / (2 * area_);
}

bool Pipeline::lines_have_no_room() const {
  // Of forty parts at 300 faces, lines of all but one take less. Those that somebody drew go only
  // where faces that follow them would bite pieces out of the border.
  constexpr double most = 0.75, most_with_marks = 0.9;
  return share_of_lines() > (has_marks() ? most_with_marks : most);
}

bool Pipeline::is_coarse_for_bends() const {
  // All were measured: beyond them the finer lattice only has more singularities.
  constexpr double most_faces = 1500, little_bent = 0.945, mostly_tubes = 0.55;
  if (share_of_thin_tubes(hierarchy_, mean_length(), context_) > mostly_tubes) return true;
  return area_ < most_faces * plan_.target.face_area(area_) &&
         flattened_share(hierarchy_, 2 * std::pow(mean_length(), 2), context_) < little_bent;
}

double Pipeline::share_of_holes() const {
  return meshgrain::share_of_holes(graph(), surface_.faces.size(),
                                   area_ / plan_.target.face_area(area_), context_);
}

bool Pipeline::may_have_fine_lattice() const {
  return options_.faces == OutputFaces::quads && !is_cloud_ && nodes_are_vertices_ &&
         options_.fine_lattice && options_.guides.empty() && options_.fields == nullptr &&
         plan_.borders.empty();
}

bool Pipeline::has_given_fine_lattice() const {
  return options_.faces == OutputFaces::quads && !is_cloud_ && nodes_are_vertices_ &&
         has_given_positions(options_) && options_.fields->fine_lattice && plan_.borders.empty();
}

bool Pipeline::choose_lattice() {
  if (has_given_fine_lattice()) {
    aim_at(OutputFaces::quad_dominant);
    return true;
  }
  if (!may_have_fine_lattice()) return false;
  // A cell of the coarse lattice is two faces wide. Which shares was measured.
  const double side = plan_.target.face_side(area_);
  const auto many_abreast = [&](std::span<const std::uint8_t> on_border) {
    return share_abreast(plan_.features, on_border, 1.5 * side) > 0.25 ||
           share_abreast(plan_.features, on_border, 2 * side) > 0.6;
  };
  has_thin_limbs_ = is_coarse_for_bends();
  constexpr double few_holes = 0.1;
  const bool any = has_thin_limbs_ || (may_show_details() && share_of_holes() > few_holes);
  if (!any && !many_abreast({})) return false;  // nor are there without the borders
  if (has_branches()) return false;
  const auto border = border_edges(surface_, context_);
  if (!any && !many_abreast(mark_ends(border, surface_.positions.size()))) return false;
  aim_at(OutputFaces::quad_dominant);
  return true;
}

bool Pipeline::may_show_details() const {
  constexpr double few = 30000;
  return area_ < few * plan_.target.face_area(area_);
}

void Pipeline::refine_for_details() {
  if (choose_lattice()) refine_for_lattice();
}

void Pipeline::refine_for_lattice() {
  join_cuts();
  const bool any_split = stage_(
      "subdivide", [&] { return split_long_edges(area_, edge_lengths(surface_, context_)); });
  if (!any_split) return cut_surface();
  stage_("order", [&] { put_in_order(); });
  build_graph();
  find_lines();
  build_levels();
}

bool Pipeline::has_branches() const {
  return !cuts_.empty() || !branch_edges(surface_, context_).empty();
}

void Pipeline::size_faces() {
  Sizing sizing = options_.sizing;
  sizing.point = frame_.inside(sizing.point);
  const EdgeLength relative = relative_edge_lengths(hierarchy_, surface_, plan_.features, sizing,
                                                    plan_.target.face_side(area_), context_);
  plan_.lengths = plan_.target.edge_lengths(graph(), relative, growth(), context_);
  const double more_faces = faces_to_ask_for();
  if (plan_.borders.empty()) {
    plan_.lengths = scaled(plan_.lengths, std::sqrt(1 / more_faces));
    return;
  }
  free_lengths_ = plan_.lengths;
  // The lattice of pure quads is twice as coarse as their edges.
  const double sides = options_.faces == OutputFaces::quads ? 2 : 1;
  border_spacing_ = border_spacing(plan_.borders, graph(), mean_length(), sides, context_);
  fit_lengths_to_borders(more_faces);
}

bool Pipeline::has_quads_alone() const {
  return options_.faces == OutputFaces::quads && plan_.lattice_faces != options_.faces;
}

double Pipeline::faces_to_ask_for() const {
  if (options_.edge_length > 0) return 1;
  // A lattice spans what bends within a few cells, as its faces will. How many was measured.
  const double cells = plan_.lattice_faces == OutputFaces::quads           ? 2
                       : plan_.lattice_faces == OutputFaces::quad_dominant ? 3
                                                                           : 4;
  // Where its odd faces become quads there are more of these than cells. By how much was measured.
  const double faces_a_cell = has_quads_alone() ? 1.1 : 1;
  const double left = flattened_share(hierarchy_, cells * std::pow(mean_length(), 2), context_);
  return count_to_aim_at() / (faces_a_cell * left);
}

bool Pipeline::fit_lengths_to_borders(double more_faces) {
  const double cells = std::pow(length_for_count(graph(), plan_.lengths, 1, 1), 2) * more_faces;
  const auto fit = [&](double factor) {
    const EdgeLength lengths =
        fit_to_borders(scaled(free_lengths_, factor), border_spacing_, growth());
    plan_.lengths = graded(graph(), lengths, growth(), context_);
    return length_for_count(graph(), plan_.lengths, 1, cells);
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
  // Where even that is not enough, hardly any faces are saved by it.
  constexpr double when_missed = 1.5;
  if (high == most) fit(when_missed);
  return low > least && high < most;
}

void Pipeline::refine_for_sizes() {
  if (is_cloud_ || splits_only_once(options_) || plan_.lengths.uniform()) return;
  const double share = plan_.target.longest_edge();
  std::vector<float> longest = scaled(plan_.lengths, share).values;
  join_cuts();
  longest.resize(surface_.positions.size());
  if (!stage_("subdivide", [&] { return subdivide(surface_, longest, context_); })) {
    return cut_surface();
  }
  stage_("order", [&] {
    const std::vector<Index> order = put_in_order();
    plan_.lengths.values.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) plan_.lengths.values[i] = longest[order[i]];
    plan_.lengths = scaled(plan_.lengths, 1 / share);
  });
  build_graph();
  for (std::size_t v = plan_.lengths.values.size(); v < cuts_.sources.size(); ++v) {
    plan_.lengths.values.push_back(plan_.lengths[cuts_.sources[v]]);
  }
  find_lines();
  build_levels();
  if (!plan_.borders.empty()) return size_faces();
  plan_.lengths = graded(graph(), plan_.lengths, growth(), context_);
}

void Pipeline::orient() {
  stage_("orientation field", [&] {
    if (options_.fields != nullptr) {
      const FieldTransfer transfer(*options_.fields, graph(), frame_, context_);
      plan_.orientation = transfer.orientation();
      if (transfer.is_of_another_surface(context_)) {
        add_notes(
            {"the given fields are of another surface: each value comes from the nearest of "
             "its vertices, which is far away"});
      }
      return;
    }
    OrientationOptions orientation;
    static_cast<SolverOptions&>(orientation) = options_.solver;
    orientation.seed += plan_.other_start;
    if (plan_.is_thorough) orientation.coarse_factor = 8;
    orientation.rosy = options_.rosy != 0 ? options_.rosy : posy_of(options_.faces);
    orientation.energy = options_.orientation_energy;
    const auto edge_length = static_cast<float>(mean_length());
    // An axis has no sign, which a field of arrows needs.
    const float bends = orientation.rosy == 1 ? 0 : options_.curvature.bends;
    auto constraints = bend_constraints(hierarchy_, surface_, around_, plan_.features, edge_length,
                                        bends, context_);
    const auto curvature =
        curvature_constraints(graph(), edge_length, options_.curvature, context_);
    constraints.insert(constraints.end(), curvature.begin(), curvature.end());
    constraints.insert(constraints.end(), plan_.constraints.orientation.begin(),
                       plan_.constraints.orientation.end());
    const auto solve = [&] {
      const auto solver = OrientationSolver::create(hierarchy_, orientation, constraints);
      while (solver->step(context_)) context_.progress("orientation field", solver->progress());
      plan_.orientation = solver->field();
      plan_.orientation_energies = solver->energies();
    };
    solve();
    // Few creases are: crosses turn to them by themselves, unless the surface bends another way.
    constexpr double many = 0.08;
    if (orientation.rosy == 4 &&
        share_askew(plan_.features, graph().normals, plan_.orientation) > many) {
      const auto held = hold_to_lines(plan_.features);
      constraints.insert(constraints.end(), held.begin(), held.end());
      solve();
    }
  });
}

void Pipeline::note_scraps() {
  constexpr std::ptrdiff_t many = 10;
  if (is_cloud_ || options_.min_component > 0) return;
  const double face = plan_.target.face_area(area_);
  const auto scraps = std::ranges::count_if(piece_areas(graph(), context_),
                                            [&](double area) { return area < face; });
  if (scraps < many) return;
  plan_.notes.push_back(std::to_string(scraps) +
                        " pieces are smaller than a face, and take faces all the same: "
                        "--min-component 1 leaves them out");
}

void Pipeline::note_odd_borders() {
  if (plan_.borders.empty() || options_.faces != OutputFaces::quads) return;
  const Faces& faces = made_.extraction.mesh.faces;
  std::size_t triangles = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) triangles += faces.degree(f) == 3;
  if (triangles == 0) return;
  plan_.notes.push_back(
      std::to_string(triangles) + (triangles == 1 ? " triangle" : " triangles") +
      ": quads alone do not meet the borders that stay (none meet an odd number of edges)");
}

void Pipeline::note_parted_hexagons() {
  if (options_.faces != OutputFaces::hexagons || is_cloud_) return;
  const std::size_t before = piece_areas(graph(), context_).size();
  const std::size_t after = mesh_statistics(made_.extraction.mesh).components;
  if (after <= before) return;
  plan_.notes.push_back(fmt::format(
      "{} {} fell into {}: hexagons leave out what lies along a border, and more of them "
      "would leave out less",
      before, before == 1 ? "piece" : "pieces", after));
}

void Pipeline::report_fields() {
  const std::vector<float>& lengths = made_.position.edge_length.values;
  result_.report.edge_length = std::accumulate(lengths.begin(), lengths.end(), 0.0) /
                               static_cast<double>(lengths.size()) * frame_.scale;
  if (!options_.count_singularities || is_cloud_ || !nodes_are_vertices_) return;
  stage_("singularities", [&] {
    result_.report.orientation_singularities =
        orientation_singularities(surface_, graph().normals, plan_.orientation, context_).size();
    result_.report.position_singularities =
        position_singularities(surface_, graph(), plan_.orientation, made_.position,
                               options_.position_energy, context_)
            .size();
  });
}

void Pipeline::aim_at(OutputFaces lattice_faces) {
  plan_.lattice_faces = lattice_faces;
  const std::size_t by_default = default_vertex_count(clean_vertices_, is_cloud_);
  plan_.target = Target(wanted_, lattice_faces, by_default, frame_.scale);
}

void Pipeline::change_target(const RemeshOptions& options) {
  const double room_before = std::exchange(plan_.room_for_creases, 0);
  plan_.divides_borders = false;
  const bool started_elsewhere = std::exchange(plan_.other_start, 0) != 0;
  const bool was_thorough = std::exchange(plan_.is_thorough, false);
  wanted_ = options;
  regularity_ = options.regularity;
  aim_at(options.faces);
  may_have_faults_ = true;
  find_lines();
  const std::size_t nodes = graph().size();
  complete_levels();
  if (choose_lattice()) refine_for_lattice();
  const bool is_refined = graph().size() != nodes;
  size_faces();
  plan_.keeps_singularities.clear();
  inherent_crossings_.reset();  // what is near to them depends on the size of a face
  if (room_before == plan_.room_for_creases && !started_elsewhere && !was_thorough && !is_refined)
    return;
  orient();
}

Mesh Pipeline::roundings() const {
  Mesh roundings = roundings_;
  leave(frame_, roundings);
  for (float& value : roundings.values) value = static_cast<float>(value * frame_.scale);
  return roundings;
}

RemeshReport Pipeline::report() const {
  RemeshReport report = result_.report;
  report.notes = plan_.notes;
  report.orientation_energies = plan_.orientation_energies;
  report.position_energies = made_.position_energies;
  return report;
}

RemeshResult Pipeline::take_mesh(const RemeshReport& prepared) {
  RemeshResult level;
  level.mesh = std::move(made_.extraction.mesh);
  round_again(level.mesh, roundings_, context_);
  leave(frame_, level.mesh);
  level.report = report();
  result_.report = prepared;
  plan_.notes = prepared.notes;
  made_ = {};
  return level;
}

RemeshResult Pipeline::result() && {
  if (!nodes_are_vertices_) {  // the nodes are a cloud of their own
    surface_ = Mesh();
    surface_.positions = graph().positions;
  }
  result_.report = report();
  Fields& fields = result_.fields;
  fields.surface = std::move(surface_);
  fields.surface.normals = graph().normals;
  fields.orientation = std::move(plan_.orientation);
  fields.position = std::move(made_.position);
  fields.fine_lattice = has_quads_alone();
  leave(frame_, fields);
  result_.mesh = std::move(made_.extraction.mesh);
  leave(frame_, result_.mesh);
  return std::move(result_);
}

void Pipeline::append(const FeatureConstraints& more) {
  plan_.constraints.orientation.insert(plan_.constraints.orientation.end(),
                                       more.orientation.begin(), more.orientation.end());
  plan_.constraints.position.insert(plan_.constraints.position.end(), more.position.begin(),
                                    more.position.end());
}

}  // namespace meshgrain
