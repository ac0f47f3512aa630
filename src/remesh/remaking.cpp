#include "remesh/remaking.h"

#include <cstddef>
#include <limits>
#include <utility>

#include "meshgrain/statistics.h"
#include "sharpen/round_again.h"

namespace meshgrain {

Mesh Made::surface() const {
  Mesh surface = surface_in_pieces();
  join_again(surface, cuts);
  return surface;
}

Mesh Made::surface_in_pieces() const {
  Mesh surface = result.fields.surface;
  if (!has_marks) surface.marked_edges.clear();  // creases that were found are to be found anew
  return surface;
}

bool may_remake(const RemeshOptions& options) {
  return options.graph.nodes == GraphNodes::vertices && options.smoothing > 0 &&
         options.fields == nullptr && options.guides.empty() && !options.lock_borders &&
         !options.sizing.is_by_value();
}

Remaking::Remaking(Made& made, const RemeshOptions& options, const Make& make,
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

Made Remaking::made_of(Mesh surface, const RemeshOptions& options, const Made& before,
                       const std::string& note) {
  const Wanted wanted{made_.faults, keeps_creases_};
  Made other = make_(std::move(surface), options, wanted, context_);
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
  add_triangles(other.roundings, before.roundings);
  times_.insert(times_.end(), report.stages.begin(), report.stages.end());
  return other;
}

Made Remaking::made_without_creases(Mesh surface, const Made& before, const std::string& note) {
  RemeshOptions without = options_;
  without.features.creases = Creases::none;
  Made other = made_of(std::move(surface), without, before, note);
  other.room_for_creases = std::numeric_limits<double>::infinity();
  return other;
}

bool Remaking::keep_if_better(Made other) {
  // Faces of different pieces that pass through each other are no faults where these were left
  // apart, but they are there.
  const auto crossings = [&](const Made& of) {
    return find_crossings(of.result.mesh, context_).size();
  };
  const bool are_apart = other.cuts.empty() && !made_.cuts.empty();
  if (are_apart && crossings(other) > crossings(made_)) return false;
  if (!other.faults.are_clearly_fewer_than(made_.faults)) return false;
  made_ = std::move(other);
  return true;
}

}  // namespace meshgrain
