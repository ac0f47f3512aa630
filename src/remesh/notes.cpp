#include "remesh/notes.h"

namespace meshgrain {

std::vector<std::string> describe(const CleanReport& cleaned) {
  std::vector<std::string> notes;
  const auto note = [&](std::size_t count, const char* what) {
    if (count > 0) notes.push_back("removed " + std::to_string(count) + " " + what);
  };
  note(cleaned.repeated_corners, "repeated corners of faces");
  note(cleaned.degenerate_faces, "degenerate faces");
  note(cleaned.duplicate_faces, "duplicate faces");
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
                    " pieces open along a short curve, as they have only one side");
  }
  return notes;
}

}  // namespace meshgrain
