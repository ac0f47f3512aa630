// Points as lines of numbers: XYZ (perhaps with normals) and PTS (in blocks, their sizes first).

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

#include "io/coordinates.h"
#include "io/formats.h"
#include "io/text.h"

namespace meshgrain::io {
namespace {

bool is_unit(const Eigen::Vector3d& v) {
  return std::abs(v.norm() - 1) < 0.02;
}

bool is_comment(const Input& input, const Text& text) {
  return std::string_view(text.at(), input.end()).starts_with("//");
}

}  // namespace

Mesh read_xyz(const Input& input) {
  Mesh mesh;
  Text text(input);
  Coordinates coordinates;
  bool has_normals =
      true;  // while every line has six numbers, the last three of them a unit vector
  for (std::size_t line = 0; !text.file_ends(); ++line, text.next_line()) {
    if (line % 65536 == 0) input.progress(text.at());
    if (is_comment(input, text)) continue;
    const double x = text.number("coordinate x");
    const double y = text.number("coordinate y");
    const double z = text.number("coordinate z");
    coordinates.push(x, y, z);
    if (!has_normals) continue;
    Eigen::Vector3d n;
    has_normals = text.try_number(n.x()) && text.try_number(n.y()) && text.try_number(n.z()) &&
                  text.line_ends() && is_unit(n);
    if (has_normals) {
      mesh.normals.push_back(n.cast<float>());
    } else {
      mesh.normals = {};
    }
  }
  coordinates.move_to(mesh, input);
  return mesh;
}

Mesh read_pts(const Input& input) {
  Mesh mesh;
  Text text(input);
  Coordinates coordinates;
  std::uint64_t expected = 0;  // points up to the end of this block
  std::uint64_t begin = 0;     // points before this block
  const auto check_block = [&](const char* at) {
    if (coordinates.size() >= expected) return;
    const Item item{"point", coordinates.size() - begin, expected - begin};
    text.fail(
        at, (at == input.end() ? "the file ends before " : "the block ends before ") + item.text());
  };
  for (std::size_t line = 0; !text.file_ends(); ++line, text.next_line()) {
    if (line % 65536 == 0) input.progress(text.at());
    if (is_comment(input, text)) continue;
    Text ahead = text;
    ahead.word();
    if (ahead.line_ends()) {
      check_block(text.at());
      begin = coordinates.size();
      const char* const at = text.at();
      const std::uint64_t count = text.count("the number of points or three coordinates");
      if (count >= no_index) text.fail(at, "more points than 32 bits can number");
      expected = begin + count;
      continue;
    }
    const double x = text.number("coordinate x");
    const double y = text.number("coordinate y");
    const double z = text.number("coordinate z");
    coordinates.push(x, y, z);  // intensity and colour may follow
  }
  check_block(input.end());
  coordinates.move_to(mesh, input);
  return mesh;
}

}  // namespace meshgrain::io
