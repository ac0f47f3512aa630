#include "io/obj_runs.h"

#include <algorithm>
#include <charconv>

namespace meshgrain::io {
namespace {

/// What `read_line(line, out)` makes of lines, in parts; it returns false where the run ends.
template <typename Part, typename ReadLine>
std::vector<Part> read_run(Text& text, std::size_t most, const Input& input,
                           const ReadLine& read_line) {
  const char* const begin = text.at();
  std::vector<const char*> ends{begin};
  while (ends.back() != input.end() && ends.size() <= most) {
    ends.push_back(text.line_after(ends.back(), run_part));
  }
  const std::size_t count = ends.size() - 1;
  std::vector<Part> parts(count);
  std::vector<const char*> stops(count);
  input.context().for_ranges(count, 1, [&](std::size_t k, std::size_t) {
    Text lines = text.part(ends[k], ends[k + 1]);
    stops[k] = ends[k];
    while (!lines.at_end()) {
      if (!lines.line_ends() && !read_line(lines, parts[k])) return;
      lines.next_line();
      stops[k] = lines.at();
    }
  });
  std::size_t whole = 0;
  while (whole < count && stops[whole] == ends[whole + 1]) ++whole;
  // The part in which the run ends still counts.
  parts.resize(std::min(count, whole + 1));
  text.advance(static_cast<std::size_t>((whole < count ? stops[whole] : ends.back()) - begin));
  return parts;
}

bool read_face(Text& line, std::size_t vertices, ObjFaces& out) {
  if (!line.word_is("f")) return false;
  line.advance(1);
  const std::size_t first = out.corners.size(), had_normals = out.normals.size();
  bool is_plain = true;
  while (is_plain && !line.line_ends()) {
    const ObjCorner corner = parse_corner(line.word());
    is_plain = corner.kind == ObjCorner::Kind::index && corner.vertex >= 1 &&
               static_cast<std::uint64_t>(corner.vertex) <= vertices && corner.normal >= 0 &&
               corner.normal < no_index;
    if (!is_plain) break;
    out.corners.push_back(static_cast<Index>(corner.vertex - 1));
    if (corner.normal > 0) {
      out.normals.resize(out.corners.size() - 1, no_index);
      out.normals.push_back(static_cast<Index>(corner.normal - 1));
    }
  }
  const std::size_t degree = out.corners.size() - first;
  if (!is_plain || degree < 3) {
    out.corners.resize(first);
    out.normals.resize(had_normals);
    return false;
  }
  out.degrees.push_back(static_cast<Index>(degree));
  return true;
}

}  // namespace

ObjCorner parse_corner(std::string_view word) {
  ObjCorner corner;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, corner.vertex);
  corner.name = {word.data(), rest};
  if (error == std::errc::result_out_of_range) {
    corner.kind = ObjCorner::Kind::out_of_range;
    return corner;
  }
  const std::string_view others(rest, end);
  const bool is_index = error == std::errc() && (others.empty() || others.front() == '/') &&
                        others.find_first_not_of("/-0123456789") == others.npos;
  if (!is_index) return corner;
  corner.kind = ObjCorner::Kind::index;
  // The last of two or three numbers is the normal's if another one, or nothing, comes before it.
  const std::size_t slash = others.rfind('/');
  if (slash == others.npos || slash == 0) return corner;
  std::from_chars(rest + slash + 1, end, corner.normal);
  return corner;
}

std::vector<ObjNumbers> read_run_of_numbers(Text& text, std::string_view name, std::size_t parts,
                                            const Input& input) {
  return read_run<ObjNumbers>(text, parts, input, [&](Text& line, ObjNumbers& out) {
    if (!line.word_is(name)) return false;
    line.advance(name.size());
    std::array<double, 3> row{};
    for (double& number : row) {
      if (!line.try_number(number)) return false;
    }
    out.push_back(row);
    return true;
  });
}

std::vector<ObjFaces> read_run_of_faces(Text& text, std::size_t vertices, std::size_t parts,
                                        const Input& input) {
  return read_run<ObjFaces>(text, parts, input, [&](Text& line, ObjFaces& out) {
    return read_face(line, std::min<std::size_t>(vertices, no_index), out);
  });
}

}  // namespace meshgrain::io
