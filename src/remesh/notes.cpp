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

}  // namespace meshgrain
