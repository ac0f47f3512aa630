#include "remesh/try_simpler_topology.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "mesh/weld.h"
#include "remesh/stages.h"
#include "tunnels/close_tunnels.h"

namespace meshgrain {
namespace {

/// Whether so many faces pass through each other that little can be seen of what the surface is:
/// fewer are no reason to change it.
bool has_many_crossings(const Made& made) {
  constexpr std::size_t many = 10;  // one in so many faces
  return made.faults.crossings > made.result.mesh.faces.size() / many;
}

bool has_serious_faults(const Made& made) {
  return made.faults.inverted > 0 || has_many_crossings(made);
}

double diagonal(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Vec3& p : mesh.positions) box.extend(p);
  return box.diagonal().norm();
}

class SimplerTopology {
 public:
  SimplerTopology(Made& made, const RemeshOptions& options, const Make& make,
                  const Context& context)
      : made_(made),
        options_(options),
        make_(make),
        context_(context),
        times_(made.result.report.stages),
        stage_(context, times_) {
    if (options_.edge_length == 0 && options_.face_count == 0 && options_.vertex_count == 0) {
      options_.vertex_count = made.result.mesh.positions.size();
    }
  }

  void run() {
    Mesh seamed = std::exchange(made_.seamed, {});
    Made before = made_;
    if (!seamed.faces.empty()) join_seams(std::move(seamed), before);
    close_tunnels(before);
    made_.result.report.stages = std::move(times_);
  }

 private:
  /// Tunnels may be too narrow all the same: `before` becomes what there is without seams.
  void join_seams(Mesh surface, Made& before) {
    // The two sides of a seam mostly cross a little: that alone is no reason to join them.
    if (before.faults.inverted == 0) return;
    const std::size_t merged = stage_("join seams", [&] { return weld(surface); });
    before = made_of(std::move(surface), before,
                     fmt::format("merged {} vertices along seams: faces of this size beside these "
                                 "would be inverted or pass through each other",
                                 merged));
    keep_if_better(before);
  }

  void close_tunnels(const Made& before) {
    constexpr double of_diagonal = 0.25;  // a wider tunnel is what the shape is about
    const double longest = of_diagonal * diagonal(before.result.fields.surface);
    std::size_t closed_before = 0;
    const Faults& faults = before.faults;
    const std::vector<Index>& near =
        has_many_crossings(before) ? faults.nodes : faults.nodes_of_inverted;
    // How many sides of faces are around the widest tunnels that are closed.
    for (const double sides_around : {4.0, 6.0}) {
      if (!has_serious_faults(made_)) break;
      Mesh surface = before.result.fields.surface;
      if (!before.has_marks) surface.marked_edges.clear();  // creases are found anew
      const double most = std::min(sides_around * before.side, longest);
      const std::size_t closed = stage_(
          "tunnels", [&] { return meshgrain::close_tunnels(surface, near, most, context_); });
      constexpr double considerably = 1.05;  // else it would be about the same once more
      const bool are_more =
          static_cast<double>(closed) > considerably * static_cast<double>(closed_before);
      if (!are_more) continue;
      closed_before = closed;
      keep_if_better(made_of(
          std::move(surface), before,
          fmt::format("closed {} {}: faces of this size around {} would be inverted or "
                      "pass through each other",
                      closed, closed == 1 ? "tunnel" : "tunnels", closed == 1 ? "it" : "them")));
    }
  }

  /// The report tells of the input as it was.
  Made made_of(Mesh surface, const Made& before, const std::string& note) {
    Made other = make_(std::move(surface), options_, context_);
    RemeshReport& report = other.result.report;
    const RemeshReport& first = before.result.report;
    report.input_vertices = first.input_vertices;
    report.input_faces = first.input_faces;
    // And so do the notes, but for those of the faces, which come last.
    report.notes.erase(report.notes.begin(),
                       report.notes.begin() + static_cast<std::ptrdiff_t>(other.notes.size()));
    other.notes = before.notes;
    other.notes.push_back(note);
    report.notes.insert(report.notes.begin(), other.notes.begin(), other.notes.end());
    times_.insert(times_.end(), report.stages.begin(), report.stages.end());
    return other;
  }

  void keep_if_better(Made other) {
    if (other.faults.are_clearly_fewer_than(made_.faults)) made_ = std::move(other);
  }

  Made& made_;
  RemeshOptions options_;
  const Make& make_;
  const Context& context_;
  std::vector<StageTime> times_;
  Stages stage_;
};

}  // namespace

bool may_be_simpler(const RemeshOptions& options) {
  return options.graph.nodes == GraphNodes::vertices && options.smoothing > 0 &&
         options.fields == nullptr && options.guides.empty() && !options.lock_borders &&
         !options.sizing.is_by_value();
}

void try_simpler_topology(Made& made, const RemeshOptions& options, const Make& make,
                          const Context& context) {
  const bool is_cloud = made.result.fields.surface.is_point_cloud();
  if (is_cloud || !may_be_simpler(options) || !has_serious_faults(made)) return;
  SimplerTopology(made, options, make, context).run();
}

}  // namespace meshgrain
