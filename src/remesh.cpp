#include "meshgrain/remesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "denoise/denoise.h"
#include "extract/reduce_faces.h"
#include "extract/remove_strips.h"
#include "features/find_features.h"
#include "features/guide_constraints.h"
#include "field/transfer.h"
#include "mesh/border.h"
#include "mesh/frame.h"
#include "meshgrain/clean.h"
#include "meshgrain/error.h"
#include "meshgrain/extract.h"
#include "meshgrain/finish.h"
#include "meshgrain/hierarchy.h"
#include "meshgrain/singularities.h"
#include "meshgrain/surface.h"
#include "meshgrain/triangulate.h"
#include "remesh/notes.h"
#include "remesh/stages.h"
#include "remesh/target.h"
#include "symmetry/remesh_symmetric.h"

namespace meshgrain {
namespace {

void check(const RemeshOptions& options) {
  const int posy = posy_of(options.faces);
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
  if (!(options.sizing.grading > 1)) throw Error("the grading of sizes must be larger than 1");
  if (options.smoothing < 0) throw Error("the number of smoothing iterations must not be negative");
  if (options.solver.sweeps < 1) throw Error("at least one sweep a level is needed");
}

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

/// One call of remesh(): each stage leaves what the next ones need. What prepare() has done can
/// serve several meshes.
class Pipeline {
 public:
  Pipeline(const Mesh& input, const RemeshOptions& options, const Context& context)
      : options_(options),
        context_(context),
        stage_(context, result_.report.stages),
        is_cloud_(input.is_point_cloud()),
        nodes_are_vertices_(is_cloud_ || options.graph.nodes == GraphNodes::vertices) {
    result_.report.input_vertices = input.positions.size();
    result_.report.input_faces = input.faces.size();
  }

  /// All that does not depend on the number of faces, but as fine as the target needs it.
  void prepare(Mesh input) {
    clean_up(std::move(input));
    sharpen();
    refine();
    build_levels();
    find_lines();
    size_faces();
    refine_for_sizes();
    orient();
  }

  void make_mesh() {
    position_and_extract();
    count_singularities();
    smooth_faces();
  }

  /// Another target, not finer than the one that all was prepared for.
  void aim_at(const RemeshOptions& options) {
    target_ = Target(options, result_.report.input_vertices, frame_.scale);
    find_lines();
    size_faces();
  }

  /// The mesh alone; the rest stays for the next one.
  RemeshResult take_mesh(const RemeshReport& prepared) {
    RemeshResult level;
    level.mesh = std::move(extraction_.mesh);
    leave(frame_, level.mesh);
    level.report = std::exchange(result_.report, prepared);
    extraction_ = {};
    is_split_ = false;
    return level;
  }

  const RemeshReport& report() const { return result_.report; }

  RemeshResult result() && {
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

 private:
  /// A clean surface of triangles (or points), about one unit large.
  void clean_up(Mesh input) {
    stage_("clean", [&] {
      result_.report.notes = describe(clean(input));
      frame_ = unit_frame(input);
      target_ = Target(options_, result_.report.input_vertices, frame_.scale);
      enter(frame_, input);
      surface_ = is_cloud_ ? std::move(input) : triangulate(input);
      drop_pieces();
    });
  }

  /// Without noise if it is a scan of a mechanical part.
  void sharpen() {
    if (is_cloud_ || !nodes_are_vertices_) return;
    if (options_.features.creases != Creases::automatic) return;
    stage_("noise", [&] {
      const double side = target_.face_side(surface_area(surface_));
      is_sharpened_ = sharpen_noisy_part(surface_, side, context_);
      if (!is_sharpened_) return;
      result_.report.notes.push_back(
          "a noisy scan of a mechanical part: its noise was taken out to make its creases sharp");
    });
  }

  /// Fine enough for the target, and in the order of a curve.
  void refine() {
    if (!is_cloud_) {
      stage_("subdivide", [&] {
        const double area = surface_area(surface_);
        if (!(area > 0)) throw Error("the input has no surface: all of its faces are degenerate");
        // Where faces vary in size, and nothing can be split later on, fine enough for the
        // smallest.
        const bool once = !nodes_are_vertices_ || !options_.guides.empty();
        const bool varied = once && !options_.sizing.is_uniform();
        const double length = target_.edge_length(area) / (varied ? options_.sizing.ratio : 1);
        const EdgeLengths edges = edge_lengths(surface_);
        const double limit = std::min(length / 2, 2 * edges.mean);
        if (edges.max > limit) subdivide(surface_, limit, context_);
      });
    }
    if (!is_cloud_) lay_guides(target_.edge_length(surface_area(surface_)));
    stage_("order", [&] {
      const std::vector<Index> order = sort_along_curve(surface_, context_);
      if (!guides_.edges.empty()) renumber(guides_, order);
    });
  }

  void build_levels() {
    Graph finest = stage_("graph", [&] { return build_graph(surface_, options_.graph, context_); });
    result_.report.nodes = finest.size();
    result_.report.edges = finest.neighbors.size() / 2;
    stage_("hierarchy", [&] { hierarchy_ = build_hierarchy(std::move(finest), context_); });
    result_.report.levels = hierarchy_.levels.size();
  }

  void find_lines() {
    area_ = 0;
    for (const float a : graph().areas) area_ += a;
    mean_length_ = target_.edge_length(area_);
    if (is_cloud_) {
      soft_guides_.clear();
      lay_guides(mean_length_);
    }
    constraints_ = guide_constraints(graph(), soft_guides_);
    if (is_cloud_ || !nodes_are_vertices_) return;
    stage_("features", [&] {
      FeatureOptions options = options_.features;
      if (options_.orientation_energy != OrientationEnergy::extrinsic) options.orient_creases = 1;
      // Triangles cannot follow two creases that meet at right angles.
      if (posy_of(options_.faces) == 6) options.align_creases = 0.3f;
      if (is_sharpened_) options.creases = Creases::marked;
      features_ = find_features(surface_, options, guides_, target_.face_side(area_), context_);
      append(feature_constraints(features_));
      append(guide_constraints(guides_, features_.corners));
    });
  }

  void size_faces() {
    Sizing sizing = options_.sizing;
    sizing.point = frame_.inside(sizing.point);
    const EdgeLength relative = relative_edge_lengths(hierarchy_, surface_, features_, sizing,
                                                      target_.face_side(area_), context_);
    lengths_ = target_.edge_lengths(graph(), relative, growth(), context_);
  }

  /// Finer still where small faces are wanted.
  void refine_for_sizes() {
    // Guides are cut into the surface by now.
    const bool may_split = !is_cloud_ && nodes_are_vertices_ && options_.guides.empty();
    if (!may_split || lengths_.uniform()) return;
    std::vector<float> longest = scaled(lengths_, 0.5).values;
    if (!stage_("subdivide", [&] { return subdivide(surface_, longest, context_); })) return;
    stage_("order", [&] {
      const std::vector<Index> order = sort_along_curve(surface_, context_);
      lengths_.values.resize(order.size());
      for (std::size_t i = 0; i < order.size(); ++i) lengths_.values[i] = 2 * longest[order[i]];
    });
    build_levels();
    find_lines();
    lengths_ = graded(graph(), lengths_, growth(), context_);
  }

  void orient() {
    stage_("orientation field", [&] {
      if (options_.fields != nullptr) {
        fields().orientation = transfer_orientation(*options_.fields, graph(), frame_, context_);
        return;
      }
      OrientationOptions orientation;
      static_cast<SolverOptions&>(orientation) = options_.solver;
      orientation.rosy = options_.rosy != 0 ? options_.rosy : posy_of(options_.faces);
      orientation.energy = options_.orientation_energy;
      auto constraints = curvature_constraints(graph(), static_cast<float>(mean_length_),
                                               options_.curvature, context_);
      constraints.insert(constraints.end(), constraints_.orientation.begin(),
                         constraints_.orientation.end());
      const auto solver = OrientationSolver::create(hierarchy_, orientation, constraints);
      while (solver->step(context_)) context_.progress("orientation field", solver->progress());
      fields().orientation = solver->field();
      result_.report.orientation_energies = solver->energies();
    });
  }

  /// Positions and the mesh. Where a count was asked for and missed, again with edges that much
  /// longer or shorter. A few faces too many can be taken away one by one: that costs some
  /// regularity, so that more of it is allowed only when other lengths have not helped.
  void position_and_extract() {
    constexpr int attempts = 8;
    constexpr double tolerance = 0.008;
    const bool given = options_.fields != nullptr && !options_.fields->position.points.empty();
    double least_error = std::numeric_limits<double>::infinity();
    for (int attempt = 0; attempt < attempts; ++attempt) {
      PositionField positions = stage_("position field", [&] {
        return given ? transfer_position(*options_.fields, graph(), frame_, context_)
                     : solve_positions();
      });
      Extraction found = stage_("extraction", [&] { return extract(positions); });
      const double ratio = target_.count_ratio(found.mesh);
      // A few faces too many can be taken away, but not added.
      const bool met = std::abs(ratio - 1) < tolerance;
      const double error = met ? 0 : ratio < 1 ? 1 / ratio - 1 : (ratio - 1) / 5;
      if (error < least_error) {
        least_error = error;
        extraction_ = std::move(found);
        fields().position = std::move(positions);
      }
      const double closing = attempt < 3 ? tolerance : 0.03;
      if (given || (ratio > 1 - tolerance && ratio < 1 + closing)) break;
      const double aim = attempt < 3 ? 1 : 1.01;
      const double factor = std::clamp(std::sqrt(ratio / aim), 0.5, 2.0);
      lengths_ = graded(graph(), scaled(lengths_, factor), growth(), context_);
    }
    const double ratio = target_.count_ratio(extraction_.mesh);
    if (ratio > 1 + tolerance && ratio < 1.2) {
      stage_("extraction", [&] { take_away_faces(tolerance); });
    }
    if (extraction_.mesh.faces.empty()) {
      throw Error(
          "nothing is left of the surface at this target: ask for more faces, or shorter edges");
    }
    result_.report.edge_length = fields().position.edge_length[0] * frame_.scale;
  }

  /// Whole strips if that can be, else single faces.
  void take_away_faces(double tolerance) {
    if (options_.faces == OutputFaces::quads) {
      Extraction quads = extraction_;
      split_into_quads(quads);
      const auto count = static_cast<double>(quads.mesh.faces.size());
      const double wanted = count / target_.count_ratio(extraction_.mesh);
      constexpr double one_percent = 0.0099;  // strips are long: all that may be
      const auto least = static_cast<std::size_t>(std::ceil(count - (1 + one_percent) * wanted));
      const auto most = static_cast<std::size_t>(count - (1 - one_percent) * wanted);
      if (remove_strips(quads, least, most, context_)) {
        extraction_ = std::move(quads);
        is_split_ = true;
        return;
      }
    }
    reduce_faces(extraction_, posy_of(options_.faces),
                 target_.faces_to_close(extraction_.mesh, tolerance), context_);
  }

  void count_singularities() {
    if (is_cloud_ || !nodes_are_vertices_) return;
    stage_("singularities", [&] {
      result_.report.orientation_singularities =
          orientation_singularities(surface_, graph().normals, fields().orientation, context_)
              .size();
      result_.report.position_singularities =
          position_singularities(surface_, graph(), fields().orientation, fields().position,
                                 options_.position_energy, context_)
              .size();
    });
  }

  void smooth_faces() {
    stage_("smoothing", [&] {
      if (options_.faces == OutputFaces::quads && !is_split_) split_into_quads(extraction_);
      SmoothOptions smoothing;
      smoothing.iterations = options_.smoothing;
      // The more regular, the more the grid must stretch. Triangles of one size are regular; the
      // triangles among quads are smaller than these.
      if (options_.faces == OutputFaces::quads) {
        smoothing.evenness = 0.59 + 0.12 * options_.regularity;
      }
      if (options_.faces == OutputFaces::triangles) smoothing.evenness = 0.87;
      if (options_.faces == OutputFaces::quad_dominant) smoothing.evenness = 0.48;
      const EdgeLength& lengths = fields().position.edge_length;
      if (!lengths.uniform() && nodes_are_vertices_) smoothing.relative_size = lengths;
      smoothing.lift = options_.sizing.adaptive;
      if (!is_cloud_ && nodes_are_vertices_) smoothing.features = &features_;
      smooth(extraction_, surface_, graph(), smoothing, context_);
    });
  }

  void drop_pieces() {
    if (is_cloud_ || options_.min_component == 0) return;
    const double area = options_.min_component * target_.face_area(surface_area(surface_));
    if (const std::size_t dropped = drop_small_pieces(surface_, area)) {
      result_.report.notes.push_back(
          "left out " + std::to_string(dropped) + " pieces with room for fewer than " +
          std::to_string(std::lround(options_.min_component)) + " faces");
    }
  }

  /// Guides onto the surface: those that edges must follow are cut into it.
  void lay_guides(double edge_length) {
    if (options_.guides.empty()) return;
    stage_("guides", [&] {
      std::vector<Guide> guides = options_.guides;
      for (Guide& guide : guides) {
        for (Eigen::Vector3d& p : guide.points) p = frame_.inside(p);
      }
      std::vector<EdgeOfLine> lines;
      const bool cut = !is_cloud_ && nodes_are_vertices_;
      if (cut) lines = feature_edges(surface_, options_.features, context_);
      TracedGuides traced = trace_guides(surface_, guides, lines, edge_length, frame_.scale);
      result_.report.notes.insert(result_.report.notes.end(), traced.notes.begin(),
                                  traced.notes.end());
      const auto is_hard = [&](const GuideRun& run) { return cut && run.strength == 1; };
      std::vector<GuideRun> hard;
      for (GuideRun& run : traced.runs)
        (is_hard(run) ? hard : soft_guides_).push_back(std::move(run));
      if (cut) guides_ = cut_guides(surface_, hard);
    });
  }

  void append(const FeatureConstraints& more) {
    constraints_.orientation.insert(constraints_.orientation.end(), more.orientation.begin(),
                                    more.orientation.end());
    constraints_.position.insert(constraints_.position.end(), more.position.begin(),
                                 more.position.end());
  }

  double growth() const { return target_.growth(options_.sizing.grading); }
  const Graph& graph() const { return hierarchy_.levels[0]; }
  Fields& fields() { return result_.fields; }

  PositionField solve_positions() {
    PositionOptions position;
    static_cast<SolverOptions&>(position) = options_.solver;
    position.posy = posy_of(options_.faces);
    position.energy = options_.position_energy;
    const auto solver = PositionSolver::create(hierarchy_, fields().orientation, lengths_, position,
                                               constraints_.position);
    while (solver->step(context_)) context_.progress("position field", solver->progress());
    result_.report.position_energies = solver->energies();
    return solver->field();
  }

  /// What regularity may cost (ExtractOptions): the lattice of pure quads is twice as coarse as
  /// their edges, so that there the same cost bends the surface's grid over a longer way.
  double cancelling_cost() const {
    if (options_.regularity >= 1) return std::numeric_limits<double>::infinity();
    const double least = options_.faces == OutputFaces::quads           ? 2.5
                         : options_.faces == OutputFaces::quad_dominant ? 5.4
                                                                        : 6;
    // Sizes that vary need the dislocations where rows end.
    const double regularity = options_.regularity / (lengths_.uniform() ? 1 : 2);
    return least * (1 + 2 * regularity / (1 - regularity));
  }

  Extraction extract(const PositionField& positions) {
    ExtractOptions extract;
    extract.energy = options_.position_energy;
    extract.manifold = options_.manifold;
    extract.cancelling_cost = cancelling_cost();
    if (is_cloud_) {
      extract.largest_filled_gap = 12;  // a larger one may well be a hole
    } else if (nodes_are_vertices_) {
      extract.surface = &surface_;
      extract.features = &features_;
    } else {
      extract.border = border_of_faces(surface_, graph());
    }
    Extraction found = extract_mesh(graph(), fields().orientation, positions, extract, context_);
    if (!nodes_are_vertices_) {
      for (Index& node : found.nodes) node = std::as_const(surface_.faces)[node][0];
    }
    if (options_.manifold) make_manifold(found);
    if (options_.faces == OutputFaces::hexagons) take_dual(found);
    return found;
  }

  const RemeshOptions& options_;
  const Context& context_;
  RemeshResult result_;
  Stages stage_;
  Frame frame_;
  Target target_;
  bool is_cloud_, nodes_are_vertices_;
  bool is_sharpened_ = false;
  Mesh surface_;
  Hierarchy hierarchy_;
  double area_ = 0, mean_length_ = 0;
  EdgeLength lengths_;
  GuideLines guides_;                  // that edges follow
  std::vector<GuideRun> soft_guides_;  // that fields are drawn to
  FeatureLines features_;
  FeatureConstraints constraints_;
  Extraction extraction_;
  bool is_split_ = false;  // into the quads that are written
};

}  // namespace

RemeshResult remesh(Mesh input, const RemeshOptions& options, const Context& context) {
  check(options);
  if (options.symmetry.any()) return remesh_symmetric(std::move(input), options, context);
  Pipeline pipeline(input, options, context);
  pipeline.prepare(std::move(input));
  pipeline.make_mesh();
  return std::move(pipeline).result();
}

std::vector<RemeshResult> remesh_levels(Mesh input, std::span<const std::size_t> face_counts,
                                        RemeshOptions options, const Context& context) {
  if (face_counts.empty() || *std::min_element(face_counts.begin(), face_counts.end()) == 0) {
    throw Error("levels need numbers of faces, all of them positive");
  }
  if (options.symmetry.any()) throw Error("several levels cannot be made symmetric");
  if (options.fields != nullptr && !options.fields->position.points.empty()) {
    throw Error("given positions decide how fine a mesh is, and make but one");
  }
  options.edge_length = 0;
  options.face_count = *std::max_element(face_counts.begin(), face_counts.end());
  check(options);
  Pipeline pipeline(input, options, context);
  pipeline.prepare(std::move(input));
  const RemeshReport prepared = pipeline.report();
  std::vector<std::size_t> order(face_counts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return face_counts[a] > face_counts[b]; });
  std::vector<RemeshResult> levels(face_counts.size());
  for (const std::size_t k : order) {
    if (k != order.front()) {
      RemeshOptions level = options;
      level.face_count = face_counts[k];
      pipeline.aim_at(level);
    }
    pipeline.make_mesh();
    levels[k] = pipeline.take_mesh(prepared);
  }
  return levels;
}

}  // namespace meshgrain
