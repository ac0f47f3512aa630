// The stages of the pipeline that make a surface ready for its graph.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloud/thin_out.h"
#include "mesh/border.h"
#include "mesh/long_edges.h"
#include "mesh/orient_faces.h"
#include "mesh/refine_slivers.h"
#include "mesh/seams.h"
#include "mesh/turn_caps.h"
#include "mesh/weld.h"
#include "meshgrain/clean.h"
#include "meshgrain/error.h"
#include "meshgrain/surface.h"
#include "meshgrain/triangulate.h"
#include "remesh/clean_input.h"
#include "remesh/memory.h"
#include "remesh/notes.h"
#include "remesh/pipeline.h"
#include "remesh/sharpen_part.h"

namespace meshgrain {
namespace {

std::vector<std::uint8_t> picked(const std::vector<std::uint8_t>& flags,
                                 const std::vector<Index>& which) {
  std::vector<std::uint8_t> result;
  for (const Index i : which) result.push_back(flags[i]);
  return result;
}

}  // namespace

void Pipeline::clean_up(Mesh input) {
  // What is read comes in any order; all that looks at neighbours is quicker with these nearby.
  constexpr std::size_t many = 1 << 16;
  if (input.positions.size() > many && input.faces.uniform_degree() >= 3 && !is_torn(input)) {
    stage_("order", [&] { sort_along_curve(input, context_); });
    is_in_order_ = true;
  }
  stage_("clean", [&] {
    plan_.notes = clean_input(input, context_);
    clean_vertices_ = input.positions.size();
    frame_ = unit_frame(input, context_);
    aim_at(options_.faces);
    enter(frame_, input, context_);
    const bool is_ready = is_cloud_ || input.faces.uniform_degree() == 3;
    surface_ = is_ready ? std::move(input) : triangulate(input);
    if (!is_cloud_ && !options_.lock_borders) turn_caps(surface_, context_);
    const OrientReport oriented = orient_faces(surface_, context_);
    add_notes(describe(oriented));
    if (!is_cloud_ && oriented.may_have_border) clean_border();
    drop_pieces();
    was_marked_ = !surface_.marked_edges.empty();
  });
}

void Pipeline::clean_border() {
  if (!options_.lock_borders) drop_rounding(surface_, context_);  // which else keeps seams apart
  auto border = border_edges(surface_, context_);
  add_notes(contract_border_of(surface_, border, context_));
  const SeamReport seams = find_seams(surface_, border);
  if (!options_.lock_borders && seams.are_all() && are_cracks(border)) {
    const std::size_t merged = weld(surface_);
    add_notes({fmt::format(
        "merged {} vertices along seams: most are too short for faces of this size", merged)});
    clean(surface_, context_);
    orient_faces(surface_, context_);
    return;
  }
  add_notes(describe(seams));
  is_seamed_ = seams.are_many();
}

bool Pipeline::are_cracks(std::span<const std::array<Index, 2>> border) const {
  constexpr double sides = 3;  // there and back again
  const double side = plan_.target.face_side(surface_area(surface_, context_));
  return has_short_loops(surface_, border, sides * side);
}

Mesh Pipeline::seamed_surface() const {
  constexpr std::size_t most = 1 << 20;  // vertices: scans of many more have faces enough
  const bool may_be_copied = options_.memory_limit == 0 && surface_.positions.size() <= most;
  if (!is_seamed_ || !may_be_copied) return {};
  Mesh surface = surface_;
  leave(frame_, surface);
  return surface;
}

void Pipeline::add_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) {
    // What was found for one target may be found again for another.
    const bool is_new = std::ranges::find(plan_.notes, note) == plan_.notes.end();
    if (is_new) plan_.notes.push_back(note);
  }
}

void Pipeline::drop_pieces() {
  if (is_cloud_ || options_.min_component == 0) return;
  const double area =
      options_.min_component * plan_.target.face_area(surface_area(surface_, context_));
  if (const std::size_t dropped = drop_small_pieces(surface_, area)) {
    const double least = options_.min_component;
    plan_.notes.push_back(
        fmt::format("left out {} {} ", dropped, dropped == 1 ? "piece" : "pieces") +
        (least == 1 ? "smaller than a face"
                    : fmt::format("with room for fewer than {:g} faces", least)));
  }
}

void Pipeline::sharpen() {
  if (is_cloud_) return;
  stage_("sharpen", [&] {
    input_size_ = surface_size(surface_, context_);
    const double side = plan_.target.face_side(input_size_.area);
    is_sharpened_ = sharpen_part(surface_, options_, side, plan_.notes, context_);
    // Most meshes without edges much longer than those of faces are scans, and so are very large
    // ones, of which all edges and copies would take much memory.
    constexpr std::size_t most = 1 << 20;  // vertices
    const bool may_have_bends =
        !is_sharpened_ && input_size_.edges.max > 2 * side && surface_.positions.size() <= most;
    Mesh* const roundings = keeps_border_ ? nullptr : &roundings_;
    const bool has_changed =
        is_sharpened_ || (may_have_bends && sharpen_narrow_bends(surface_, options_, side,
                                                                 roundings, plan_.notes, context_));
    if (has_changed) input_size_ = surface_size(surface_, context_);
  });
  if (options_.lock_borders) locked_ = rim_vertices(surface_, context_);
}

void Pipeline::coarsen() {
  if (is_cloud_) return thin_out_cloud();
  if (!plan_.target.is_dense(options_, surface_.positions.size(), input_size_)) return;
  if (!is_in_order_) stage_("order", [&] { put_in_order(); });
  // What is a crease is to be seen where the surface is as it was.
  stage_("features", [&] {
    had_marks_ = !surface_.marked_edges.empty();
    const double side = plan_.target.face_side(input_size_.area);
    const auto creases = find_creases(surface_, feature_options(), side, context_);
    surface_.marked_edges.insert(surface_.marked_edges.end(), creases.begin(), creases.end());
  });
  is_coarsened_ = true;
  stage_("coarsen", [&] {
    std::vector<std::uint8_t> stays(surface_.positions.size(), 0);
    for (const auto& [a, b] : surface_.marked_edges) stays[a] = stays[b] = 1;
    const CoarseEdges edges = plan_.target.coarse_edges(options_, input_size_.area);
    is_in_order_ = false;
    const auto kept = meshgrain::coarsen(surface_, edges, std::move(stays), context_);
    if (!locked_.empty()) locked_ = picked(locked_, kept);
    input_size_ = surface_size(surface_, context_);
    check_memory_of_coarse(surface_, input_size_.area, options_, plan_.target, context_);
  });
}

void Pipeline::thin_out_cloud() {
  if (!plan_.target.may_be_dense(options_, surface_.positions.size())) return;
  if (!is_in_order_) stage_("order", [&] { put_in_order(); });
  stage_("coarsen", [&] { thin_out(surface_, plan_.target.density_of_cloud(options_), context_); });
}

FeatureOptions Pipeline::feature_options() const {
  FeatureOptions options = options_.features;
  if (leaves_out_creases()) {
    options.creases = Creases::none;
    return options;
  }
  if (is_sharpened_ || (is_coarsened_ && options.creases != Creases::none)) {
    options.creases = Creases::marked;
  }
  options.marks_may_go = options.marks_may_go || (is_coarsened_ && !had_marks_);
  return options;
}

void Pipeline::refine() {
  if (!is_cloud_) {
    const double area = input_size_.area;
    if (!(area > 0)) throw Error("the input has no surface: all of its faces are degenerate");
    plan_.target.refuse_too_many(area);
    stage_("subdivide", [&] { split_long_edges(area, input_size_.edges); });
    lay_guides(plan_.target.edge_length(area));
  }
  if (!is_in_order_) stage_("order", [&] { put_in_order(); });
}

bool Pipeline::split_long_edges(double area, const EdgeLengths& edges) {
  const double limit = is_coarsened_ ? plan_.target.coarse_edges(options_, area).longest
                                     : plan_.target.longest_input_edge(options_, area, edges.mean);
  if (!(edges.max > limit)) return false;
  std::vector<Index> faces = faces_with_long_edges(surface_, limit, context_);
  if (refine_slivers(surface_, limit, faces, context_)) {
    faces = faces_with_long_edges(surface_, limit, context_);
  }
  subdivide_faces(surface_, limit, std::move(faces), context_);
  is_in_order_ = false;
  return true;
}

std::vector<Index> Pipeline::put_in_order() {
  const std::size_t count = surface_.positions.size();
  const std::vector<Index> order = sort_along_curve(surface_, context_);
  if (!guides_.edges.empty()) renumber(guides_, order);
  if (locked_.empty()) return order;
  locked_.resize(count, 0);  // what was split off is no vertex of the input
  locked_ = picked(locked_, order);
  return order;
}

void Pipeline::lay_guides(double edge_length) {
  if (options_.guides.empty()) return;
  stage_("guides", [&] {
    std::vector<Guide> guides = options_.guides;
    for (Guide& guide : guides) {
      for (Eigen::Vector3d& p : guide.points) p = frame_.inside(p);
    }
    std::vector<EdgeOfLine> lines;
    const bool cut = !is_cloud_ && nodes_are_vertices_;
    if (cut) {
      const double side = plan_.target.face_side(surface_area(surface_, context_));
      lines = feature_edges(surface_, feature_options(), side, context_);
    }
    TracedGuides traced = trace_guides(surface_, guides, lines, edge_length, frame_.scale);
    add_notes(traced.notes);
    const auto is_hard = [&](const GuideRun& run) { return cut && run.strength == 1; };
    std::vector<GuideRun> hard;
    for (GuideRun& run : traced.runs)
      (is_hard(run) ? hard : soft_guides_).push_back(std::move(run));
    if (!cut) return;
    guides_ = cut_guides(surface_, hard, context_);
    is_in_order_ = false;
  });
}

}  // namespace meshgrain
