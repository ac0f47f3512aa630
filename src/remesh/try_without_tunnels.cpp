#include "remesh/try_without_tunnels.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "remesh/stages.h"
#include "tunnels/close_tunnels.h"

namespace meshgrain {
namespace {

/// Borders and guides that stay, and values of vertices, are those of the surface as it is.
bool may_close_any(const Made& made, const RemeshOptions& options) {
  return !made.result.fields.surface.is_point_cloud() &&
         options.graph.nodes == GraphNodes::vertices && options.smoothing > 0 &&
         options.fields == nullptr && options.guides.empty() && !options.lock_borders &&
         !options.sizing.is_by_value();
}

/// Whether faults are more than a few crossings.
bool has_many_faults(const Made& made) {
  return made.faults.inverted > 0 ||
         made.faults.crossings > made.result.mesh.faces.size() / Flaws::hopeless;
}

/// The report of a mesh without tunnels tells of the input as it was.
void continue_report(RemeshReport& report, const Made& before, std::size_t closed) {
  const RemeshReport& first = before.result.report;
  report.input_vertices = first.input_vertices;
  report.input_faces = first.input_faces;
  std::vector<std::string> notes = before.notes;
  for (std::string& note : report.notes) {
    if (std::ranges::find(notes, note) == notes.end()) notes.push_back(std::move(note));
  }
  notes.push_back(fmt::format(
      "closed {} {}: faces of this size around {} would be inverted or pass through each other",
      closed, closed == 1 ? "tunnel" : "tunnels", closed == 1 ? "it" : "them"));
  report.notes = std::move(notes);
}

}  // namespace

void try_without_tunnels(Made& made, const RemeshOptions& options, const Make& make,
                         const Context& context) {
  if (!may_close_any(made, options) || !has_many_faults(made)) return;
  const Made first = made;
  Eigen::AlignedBox3f box;
  for (const Vec3& p : first.result.fields.surface.positions) box.extend(p);
  constexpr double of_diagonal = 0.25;  // a wider tunnel is what the shape is about
  const double longest = of_diagonal * box.diagonal().norm();
  std::vector<StageTime> times = first.result.report.stages;
  Stages stage(context, times);
  std::size_t closed_before = 0;
  // How many sides of faces are around the widest tunnels that are closed.
  for (const double sides_around : {4.0, 6.0}) {
    if (!has_many_faults(made)) break;
    Mesh surface = first.result.fields.surface;
    if (!first.has_marks) surface.marked_edges.clear();  // creases are found anew
    const double most = std::min(sides_around * first.side, longest);
    const std::size_t closed =
        stage("tunnels", [&] { return close_tunnels(surface, first.faults.nodes, most, context); });
    constexpr double considerably = 1.05;  // else it would be about the same once more
    const bool are_more =
        static_cast<double>(closed) > considerably * static_cast<double>(closed_before);
    if (!are_more) continue;
    closed_before = closed;
    RemeshOptions again = options;
    if (again.edge_length == 0 && again.face_count == 0 && again.vertex_count == 0) {
      again.vertex_count = first.result.mesh.positions.size();
    }
    Made other = make(std::move(surface), again, context);
    const std::vector<StageTime>& took = other.result.report.stages;
    times.insert(times.end(), took.begin(), took.end());
    if (!other.faults.are_clearly_fewer_than(made.faults)) continue;
    continue_report(other.result.report, first, closed);
    made = std::move(other);
  }
  made.result.report.stages = std::move(times);
}

}  // namespace meshgrain
