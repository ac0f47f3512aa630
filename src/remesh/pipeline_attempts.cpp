// What is wrong with the faces, and the other ways that are tried then.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "finish/bare_ends.h"
#include "finish/turned_over.h"
#include "graph/spread.h"
#include "measure/crossings.h"
#include "measure/face_shape.h"
#include "mesh/border.h"
#include "meshgrain/statistics.h"
#include "remesh/pipeline.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

/// The areas of the patches that some nodes hang together in.
std::vector<double> areas_of_patches(const Graph& graph, const std::vector<Index>& nodes) {
  std::vector<std::uint8_t> is_left(graph.size(), 0);
  for (const Index i : nodes) is_left[i] = 1;
  std::vector<double> areas;
  std::vector<Index> patch;
  for (const Index start : nodes) {
    if (!std::exchange(is_left[start], std::uint8_t{0})) continue;
    double area = 0;
    patch = {start};
    for (std::size_t k = 0; k < patch.size(); ++k) {
      area += graph.areas[patch[k]];
      for (const Index j : graph.neighbors_of(patch[k])) {
        if (std::exchange(is_left[j], std::uint8_t{0})) patch.push_back(j);
      }
    }
    areas.push_back(area);
  }
  return areas;
}

}  // namespace

std::vector<Index> Pipeline::inverted_faces() const {
  const Mesh& mesh = made_.extraction.mesh;
  const auto& normals = finishing_graph().normals;
  std::vector<Index> inverted, away;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    if (face.size() == 4 && scaled_jacobian(face, mesh.positions) <= 0) {
      inverted.push_back(f);
    } else if (!is_cloud_ && looks_away(made_.extraction, f, normals)) {
      away.push_back(f);
    }
  }
  if (away.empty()) return inverted;
  const VertexFaces around = vertex_faces(mesh, context_);
  std::ranges::copy_if(away, std::back_inserter(inverted), [&](Index f) {
    return is_turned_over(made_.extraction, f, around, normals);
  });
  std::ranges::sort(inverted);
  return inverted;
}

std::size_t Pipeline::count_all_faults() const {
  return inverted_faces().size() + find_crossings(made_.extraction.mesh, context_).size();
}

LostSurface Pipeline::lost_surface() const {
  if (is_cloud_ || !nodes_are_vertices_) return {};
  const float side =
      plan_.lattice_faces == OutputFaces::quads ? 0.5f : 1;  // of an edge of the lattice
  const VertexFaces around = vertex_faces(made_.extraction.mesh, context_);
  LostSurface lost;
  lost.nodes =
      find_bare_nodes(made_.extraction, around, graph(), scaled(plan_.lengths, side), context_);
  double largest = 0, all = 0;
  for (const double area : areas_of_patches(graph(), lost.nodes)) {
    largest = std::max(largest, area);
    all += area;
  }
  lost.faces =
      std::max(all, LostSurface::weight_of_largest * largest) / plan_.target.face_area(area_);
  return lost;
}

bool Pipeline::shows_faults() const {
  return options_.smoothing > 0 && may_show_details() && !has_given_positions(options_);
}

bool Pipeline::may_be_irregular() const {
  return regularity_ <= RemeshOptions().regularity;
}

Flaws Pipeline::flaws(double lost_faces) {
  constexpr float nearly_flat = 0.1f;  // beyond it a quad is as good as any
  const float flatness = std::max(0.0f, nearly_flat - least_jacobian(made_.extraction.mesh));
  const std::size_t inverted = inverted_faces().size();
  auto crossings = find_crossings(made_.extraction.mesh, context_);
  const std::size_t all = crossings.size();
  const FaultCounts faults{inverted, own(std::move(crossings)).size()};
  return {lost_faces <= LostSurface::little ? 0 : lost_faces, flatness, faults, inverted + all};
}

std::vector<std::array<Index, 2>> Pipeline::own(std::vector<std::array<Index, 2>> crossings) {
  if (crossings.empty() || is_cloud_) return {};  // of a cloud it is not known
  if (!inherent_crossings_) {
    inherent_crossings_.emplace(surface_, cuts_, plan_.target.face_side(area_), context_);
  }
  const auto node = [&](Index f) {
    return made_.extraction.nodes[std::as_const(made_.extraction.mesh.faces)[f][0]];
  };
  std::erase_if(crossings, [&](const auto& pair) {
    return inherent_crossings_->are_near(made_.extraction.mesh, pair) ||
           (nodes_are_vertices_ && inherent_crossings_->do_touch(node(pair[0]), node(pair[1])));
  });
  return crossings;
}

Faults Pipeline::find_faults() {
  Faults faults;
  if (!may_have_faults_) return faults;
  const std::vector<Index> inverted = inverted_faces();
  // Of many faces, to look for crossings as well takes too long.
  constexpr std::size_t few = 100000;
  if (inverted.empty() && made_.extraction.mesh.faces.size() >= few) return faults;
  const Faces& faces = made_.extraction.mesh.faces;
  const auto add = [&](Index f) {
    for (const Index v : faces[f]) {
      const Index node = made_.extraction.nodes[v];
      faults.nodes.push_back(cuts_.empty() ? node : cuts_.sources[node]);
    }
  };
  faults.inverted = inverted.size();
  std::ranges::for_each(inverted, add);
  sort_unique(faults.nodes);
  faults.nodes_of_inverted = faults.nodes;
  for (const auto& [f, g] : own(find_crossings(made_.extraction.mesh, context_))) {
    ++faults.crossings;
    add(f);
    add(g);
  }
  sort_unique(faults.nodes);
  return faults;
}

void Pipeline::smooth_faces() {
  const auto are_crumpled = [&] {
    constexpr std::size_t few = 8;  // 40 meshes with more of them all had too many in the end
    return inverted_faces().size() > made_.extraction.mesh.faces.size() / few;
  };
  has_tried_without_creases_ = false;
  const bool creases_may_yield =
      may_make_others() && may_leave_out_creases() && plan_.borders.empty();
  if (!creases_may_yield) {
    smooth_faces_unless({});
  } else if (!smooth_faces_unless(are_crumpled)) {
    RoughFaces rough = std::move(rough_);
    if (try_without_creases(flaws(0), Mends::no)) rough = std::move(rough_);
    made_.extraction = std::move(rough.extraction);
    made_.is_split = rough.is_split;
    smooth_faces_unless({});
  }
  rough_ = {};
}

bool Pipeline::smooth_faces_unless(const std::function<bool()>& are_crumpled) {
  constexpr int most_attempts = 3;
  const bool may_try = may_make_others() && may_be_irregular();
  Attempt best;
  LostSurface least;
  for (int attempt = 0; may_try && attempt < most_attempts; ++attempt) {
    if (attempt > 0 && !make_faces_again()) break;
    rough_ = {made_.extraction, made_.is_split};
    LostSurface lost;
    bool is_in_vain = false;
    const auto is_worth_mending = [&] {
      is_in_vain = are_crumpled && are_crumpled();
      if (is_in_vain) return false;
      lost = lost_surface();
      return lost.faces <= LostSurface::little_before;
    };
    if (smooth_faces_if(is_worth_mending)) return true;
    if (is_in_vain) return false;
    keep_singularities_around(lost.nodes);
    Attempt now = take_attempt();
    now.made.extraction = std::move(rough_.extraction);
    now.made.is_split = rough_.is_split;
    if (attempt == 0 || lost.is_considerably_less_than(least)) {
      best = std::move(now);
      least = std::move(lost);
    }
  }
  if (may_try) put_back(std::move(best));
  if (!are_crumpled) return smooth_faces_if({});
  rough_ = {made_.extraction, made_.is_split};
  return smooth_faces_if([&] { return !are_crumpled(); });
}

void Pipeline::recover_lost_surface(const LostSurface& lost, Flaws& left) {
  const bool was_tried = !plan_.keeps_singularities.empty();  // before the faces were mended
  if (lost.faces <= LostSurface::little || !may_be_irregular() || was_tried) return;
  keep_singularities_around(lost.nodes);
  Flaws now;
  const auto is_better = [&] {
    const LostSurface still_lost = lost_surface();
    if (!still_lost.is_considerably_less_than(lost)) return false;
    now = flaws(still_lost.faces);
    return now.flatness <= left.flatness && now.faults.all() <= left.faults.all();
  };
  if (try_again(is_better)) left = now;
}

void Pipeline::keep_singularities_around(const std::vector<Index>& nodes) {
  constexpr double sides = 3.5;
  const auto reach = static_cast<float>(sides * plan_.target.face_side(area_));
  std::vector<float> distance(graph().size(), 2 * reach);
  std::vector<std::pair<float, Index>> sources;
  for (const Index i : nodes) sources.push_back({distance[i] = 0, i});
  const auto lower = [&](Index i, Index j) {
    const float farther = distance[i] + (graph().positions[j] - graph().positions[i]).norm();
    if (farther >= std::min(distance[j], reach)) return false;
    distance[j] = farther;
    return true;
  };
  spread(graph(), distance, sources, 1, lower, context_);
  plan_.keeps_singularities.resize(graph().size(), 0);
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (distance[i] < reach) plan_.keeps_singularities[i] = 1;
  }
}

bool Pipeline::follows_creases() const {
  if (!may_leave_out_creases()) return false;
  const auto on_rim = rim_vertices(surface_, context_);
  const auto is_inside = [&](Index v) { return on_rim[v] == 0; };
  return std::ranges::any_of(plan_.features.vertices, is_inside);
}

bool Pipeline::try_without_creases(const Flaws& before, Mends mends) {
  const std::size_t faces = made_.extraction.mesh.faces.size();
  const bool are_too_fine =
      before.faults.all() > 0 &&
      plan_.target.finished_ratio(made_.extraction.mesh) > 1 + plan_.target.tolerance();
  // Where there are more than two faults a face, nothing helps.
  if (!(before.are_hopeless(faces) || are_too_fine) || before.faults.all() > 2 * faces)
    return false;
  if (!follows_creases()) return false;
  const auto is_better = [&] { return 2 * flaws(0).faults.all() < before.faults.all(); };
  // Those that are everywhere, as steps of voxels are, are no better where some are left. Of 23
  // parts of machines, lines of one take more.
  constexpr double everywhere = 0.5;  // of all edges
  const double least_room = share_of_lines() > everywhere ? no_creases : plan_.room_for_creases;
  has_tried_without_creases_ = true;
  for (const double room : {1.0, 2.0, no_creases}) {
    if (room < least_room || room == plan_.room_for_creases) continue;
    if (room == no_creases && keeps_creases_) continue;
    const auto leave_out = [&] {
      plan_.room_for_creases = room;
      plan_.keeps_singularities.clear();
      aim_at(options_.faces);
      find_lines();
      complete_levels();
      orient();
    };
    if (!try_again(is_better, leave_out, mends)) continue;
    std::vector<std::string>& notes = plan_.notes;
    std::erase_if(notes, [](const auto& note) { return note.starts_with("without some creases"); });
    notes.emplace_back(fmt::format(
        "without {}creases{}: faces of this size that follow them would {}pass through each other",
        room == no_creases ? "" : "some ", was_marked() ? " and marked edges" : "",
        was_marked() ? "be inverted or " : ""));
    return true;
  }
  return false;
}

bool Pipeline::try_divided_borders(const Flaws& before) {
  if (plan_.borders.empty() || plan_.divides_borders || before.faults.all() == 0) return false;
  const auto locked =
      locked_between(plan_.borders, surface_, locked_, plan_.target.face_side(area_));
  if (locked == locked_) return false;
  const auto is_better = [&] { return 2 * flaws(0).faults.all() <= before.faults.all(); };
  const auto divide = [&] {
    plan_.divides_borders = true;
    find_lines();
  };
  if (!try_again(is_better, divide)) return false;
  plan_.notes.emplace_back(
      "divided edges of the border that are far longer than a face: faces that meet them as they "
      "are would be folded or pass through each other");
  return true;
}

bool Pipeline::mend_flaws() {
  if (!may_make_others()) return false;
  LostSurface lost = lost_surface();
  Flaws left = flaws(lost.faces);
  if (try_divided_borders(left) || (!has_tried_without_creases_ && try_without_creases(left))) {
    lost = lost_surface();
    left = flaws(lost.faces);
  }
  if (!may_be_of_use(left.faults)) return false;
  recover_lost_surface(lost, left);
  // A finer lattice costs half as many irregular vertices again.
  const bool is_coarse = plan_.lattice_faces == OutputFaces::quads;
  const bool has_lost = !plan_.keeps_singularities.empty();  // or had
  if (!left.any() || !has_lost || !is_coarse || !may_have_fine_lattice() || has_branches()) {
    may_have_faults_ = try_other_starts(left).faults.all() > 0;
    return false;
  }
  made_ = {};
  plan_.keeps_singularities.clear();
  aim_at(OutputFaces::quad_dominant);
  const std::size_t nodes = graph().size();
  refine_for_lattice();
  complete_levels();
  size_faces();
  refine_for_sizes();
  if (graph().size() != nodes) orient();
  return true;
}

Flaws Pipeline::try_other_starts(Flaws before) {
  const std::size_t faces = made_.extraction.mesh.faces.size();
  if (before.are_hopeless(faces) || before.are_inherent(faces)) return before;
  constexpr std::uint64_t most = 2;
  for (std::uint64_t start = 1; start <= most && before.any(); ++start) {
    Flaws now;
    const auto is_better = [&] {
      now = flaws(lost_surface().faces);
      return now.are_fewer_than(before);
    };
    const auto start_there = [&] {
      plan_.other_start = start;
      complete_levels();
      orient();
    };
    if (try_again(is_better, start_there)) before = now;
  }
  return before;
}

void Pipeline::try_coarser_lattice() {
  if (!options_.retries || plan_.lattice_faces == options_.faces || has_given_positions(options_))
    return;
  constexpr double hopeless = 0.2;
  if (inverted_faces().empty() || share_of_holes() > hopeless) return;
  const Flaws before = flaws(0);
  if (!may_be_of_use(before.faults) || before.are_inherent(made_.extraction.mesh.faces.size()))
    return;
  try_again([&] { return count_all_faults() < before.all_faults; },
            [&] { aim_at(options_.faces); });
}

bool Pipeline::is_of_use() {
  return !to_beat_ || find_faults().are_clearly_fewer_than(*to_beat_);
}

bool Pipeline::make_faces_again() {
  complete_levels();
  size_faces();
  find_faces();
  return !made_.extraction.mesh.faces.empty();
}

bool Pipeline::try_again(const std::function<bool()>& is_better,
                         const std::function<void()>& change, Mends mends) {
  Attempt before = take_attempt();
  if (change) change();
  if (make_faces_again()) {
    if (mends == Mends::no) {
      smooth_faces_unless([] { return true; });
    } else {
      smooth_faces_unless({});
      untwist_faces();
    }
    if (is_better()) {
      may_have_faults_ = true;  // other ones
      return true;
    }
  }
  put_back(std::move(before));
  return false;
}

Pipeline::Attempt Pipeline::take_attempt() {
  return {plan_, std::exchange(made_, {})};
}

void Pipeline::put_back(Attempt&& attempt) {
  plan_ = std::move(attempt.plan);
  made_ = std::move(attempt.made);
}

}  // namespace meshgrain
