#include "remesh/notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "remesh/target.h"

namespace meshgrain {

std::vector<std::string> describe(const CleanReport& cleaned) {
  std::vector<std::string> notes;
  const auto note = [&](std::size_t count, const char* what) {
    if (count > 0) notes.push_back("removed " + std::to_string(count) + " " + what);
  };
  note(cleaned.repeated_corners, "repeated corners of faces");
  note(cleaned.degenerate_faces, "degenerate faces");
  note(cleaned.duplicate_faces, "duplicate faces");
  note(cleaned.fin_faces, "faces of fins without thickness");
  note(cleaned.unused_vertices, "vertices that no face uses");
  note(cleaned.duplicate_points, "duplicate points");
  note(cleaned.loose_marks, "marked edges that no face has");
  return notes;
}

std::vector<std::string> describe(const OrientReport& oriented) {
  std::vector<std::string> notes;
  if (oriented.turned_faces > 0) {
    notes.push_back("turned " + std::to_string(oriented.turned_faces) +
                    " faces to the side of their neighbours");
  }
  if (oriented.one_sided_pieces > 0) {
    notes.push_back("cut " + std::to_string(oriented.one_sided_pieces) +
                    (oriented.one_sided_pieces == 1
                         ? " piece open along a short curve, as it has only one side"
                         : " pieces open along short curves, as they have only one side"));
  }
  return notes;
}

std::vector<std::string> describe(const SeamReport& seams) {
  std::vector<std::string> notes;
  if (seams.are_many()) {
    notes.push_back(
        std::to_string(seams.seam_edges) + " of " + std::to_string(seams.border_edges) +
        " border edges lie on each other, as along the seams of textures: --weld joins them");
  }
  return notes;
}

void note_missed_count(RemeshResult& result, const RemeshOptions& options) {
  const bool by_faces = options.face_count > 0;
  const std::size_t asked = by_faces ? options.face_count : options.vertex_count;
  if (options.edge_length > 0 || asked == 0 || has_given_positions(options)) return;
  const std::size_t made = by_faces ? result.mesh.faces.size() : result.mesh.positions.size();
  const double wanted = static_cast<double>(asked);
  const double off = static_cast<double>(made) - wanted;
  if (std::abs(off) <= std::max(1.0, 0.01 * wanted)) return;
  // In the order of what gives way to what.
  result.report.notes.push_back(
      "made " + std::to_string(made) + (by_faces ? " faces" : " vertices") + " where " +
      std::to_string(asked) + " were asked for" +
      (off > 0 ? ", as topology and features come before the count" : ""));
}

void note_faults(RemeshResult& result, const FaultCounts& faults) {
  std::vector<std::string> left;
  if (faults.inverted > 0) {
    left.push_back(
        fmt::format("{} inverted {}", faults.inverted, faults.inverted == 1 ? "face" : "faces"));
  }
  if (faults.crossings > 0) {
    left.push_back(
        fmt::format("{} of faces that pass through each other",
                    faults.crossings == 1 ? "a pair" : fmt::format("{} pairs", faults.crossings)));
  }
  if (left.empty()) return;
  result.report.notes.push_back(fmt::format("could not avoid {}: more and smaller faces may help",
                                            fmt::join(left, ", and ")));
}

}  // namespace meshgrain
