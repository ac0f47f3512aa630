// Where another regularity than the one that was asked for makes better faces.

#include <utility>

#include "measure/face_shape.h"
#include "mesh/edges.h"
#include "meshgrain/singularities.h"
#include "meshgrain/statistics.h"
#include "remesh/pipeline.h"

namespace meshgrain {
namespace {

/// How much more there may be of what mending makes less.
struct Slack {
  double singularities = 1, area_sigma = 1, angle_sigma = 1;
};

/// What the shapes of faces may cost: areas and angles each, and both together.
struct Price {
  double each, both;
};

/// By how many irregular vertices go. Neither areas nor angles get clearly less even for a few.
Price price_of(double share_left, bool is_worth_shape) {
  if (!is_worth_shape || share_left > 0.8) return {1.03, 1};
  if (share_left > 0.5) return {1.15, 1.05};
  if (share_left > 0.2) return {1.2, 1.3};
  return {1.5, 1.3};
}

/// Of the shapes of faces, for that price.
bool are_no_worse(const MeshStatistics& now, const MeshStatistics& before, bool is_worth_shape,
                  const Slack& slack = {}) {
  const double share_left = static_cast<double>(now.singularities) /
                            (slack.singularities * static_cast<double>(before.singularities));
  const Price most = price_of(share_left, is_worth_shape);
  const double area = now.area_sigma / slack.area_sigma;
  const double angle = now.angle_sigma / slack.angle_sigma;
  return area <= most.each * before.area_sigma && angle <= most.each * before.angle_sigma &&
         area * angle <= most.both * before.area_sigma * before.angle_sigma;
}

}  // namespace

void Pipeline::try_less_regular() {
  const double moderate = RemeshOptions().regularity;
  const bool may_try = options_.retries && !is_cloud_ && options_.smoothing > 0;
  if (!may_try || regularity_ <= moderate) return;
  const std::size_t before = count_all_faults();
  if (before == 0 || before > made_.extraction.mesh.faces.size() / Flaws::hopeless) return;
  for (const double share : {0.5, 0.0}) {
    regularity_ = moderate + share * (options_.regularity - moderate);
    // Where the input passes through itself there are always some.
    if (!try_again([&] { return 2 * count_all_faults() < before; })) continue;
    plan_.notes.emplace_back(
        "less regular than was asked for: faces would be inverted or pass through each other");
    return;
  }
  regularity_ = options_.regularity;
}

bool Pipeline::is_needlessly_irregular() const {
  // Over parts with large flat sides rows end that need not: singularities of positions that lie
  // far apart cancel out there at no cost of shape, other than what their ways cost suggests.
  // Among few faces each of them shows, and to try costs little.
  const bool shows_each = made_.extraction.mesh.faces.size() < few_faces;
  const double needless = shows_each ? 1 : 1.5;
  const std::size_t few = shows_each ? 1 : 8;
  const VertexDegrees degrees =
      vertex_degrees(made_.extraction.mesh, edges_of(made_.extraction.mesh));
  std::size_t irregular = 0;
  for (std::size_t v = 0; v < degrees.neighbours.size(); ++v) irregular += degrees.irregular(v);
  if (irregular <= few) return false;
  const std::size_t least =
      orientation_singularities(surface_, graph().normals, plan_.orientation, context_).size();
  return static_cast<double>(irregular - few) > needless * static_cast<double>(least);
}

void Pipeline::try_more_regular() {
  const bool may_try = options_.faces == OutputFaces::quads && may_make_others() &&
                       may_be_irregular() && !is_cloud_ && nodes_are_vertices_ &&
                       options_.sizing.is_uniform() && plan_.borders.empty() &&
                       options_.fields == nullptr;
  if (!may_try || !is_needlessly_irregular()) return;
  const Flaws flaws_before = flaws(lost_surface().faces);
  // What has flaws is seldom better with fewer rows that end, and takes long to mend.
  if (flaws_before.any()) return;
  const MeshStatistics before = mesh_statistics(made_.extraction.mesh);
  Attempt as_asked = take_attempt();
  plan_.is_thorough = true;
  complete_levels();
  orient();
  const Plan thorough = plan_;
  const auto is_better = [&](const Plan& plan, double regularity) {
    plan_ = plan;
    made_ = {};
    regularity_ = regularity;
    return make_more_regular(before, flaws_before);
  };
  if (!is_better(thorough, 1) && !is_better(thorough, 0.75) && !is_better(as_asked.plan, 1)) {
    put_back(std::move(as_asked));
  }
  regularity_ = options_.regularity;
}

bool Pipeline::make_more_regular(const MeshStatistics& before, const Flaws& flaws_before) {
  const auto are_fewer = [&](const MeshStatistics& now, double than) {
    return static_cast<double>(now.singularities) <=
           than * static_cast<double>(before.singularities);
  };
  // Who asks for less regularity than by default wants it at no cost of shape.
  const bool is_worth_shape = options_.regularity >= RemeshOptions().regularity;
  // What will not do shows early: some more irregular vertices are mended away later on, and angles
  // become more even, but areas hardly do. Of thirty that did in the end none was beyond this.
  constexpr Slack until_mended{1.2, 1.07, 1.2};
  const auto are_promising = [&] {
    return are_no_worse(mesh_statistics(made_.extraction.mesh), before, is_worth_shape,
                        until_mended);
  };
  if (!make_faces_again() || !are_fewer(mesh_statistics(made_.extraction.mesh), 1)) return false;
  if (!smooth_faces_if(are_promising)) return false;
  untwist_faces();
  untie_knots();
  constexpr double clearly = 0.9;
  const MeshStatistics now = mesh_statistics(made_.extraction.mesh);
  return are_fewer(now, clearly) && are_no_worse(now, before, is_worth_shape) &&
         flaws(lost_surface().faces).are_no_more_than(flaws_before);
}

}  // namespace meshgrain
