// Wavefront OBJ: positions, faces, lines, and the normals of point clouds; all else is ignored.

#include <fmt/format.h>

#include <charconv>

#include "io/coordinates.h"
#include "io/formats.h"
#include "io/text.h"

namespace meshgrain::io {
namespace {

/// The highest vertex that faces and lines named before it was defined, checked when all of them
/// are known.
struct ForwardReference {
  std::uint64_t number = 0;
  const char* at = nullptr;
};

/// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn`, and returns the vertex, counted from 0. Negative
/// numbers count back from the latest vertex.
Index read_corner(Text& text, std::size_t vertices, ForwardReference& forward) {
  const char* const at = text.at();
  const std::string_view word = text.word();
  const char* const end = word.data() + word.size();
  std::int64_t number = 0;
  const auto [rest, error] = std::from_chars(word.data(), end, number);
  const bool is_index = error == std::errc() && (rest == end || *rest == '/') &&
                        std::string_view(rest, end).find_first_not_of("/-0123456789") == word.npos;
  if (!is_index && error != std::errc::result_out_of_range) {
    text.fail(at, fmt::format("expected a vertex index, found {}", in_quotes(word)));
  }
  if (number < 0) number += static_cast<std::int64_t>(vertices) + 1;
  if (error != std::errc() || number < 1 || number >= no_index) {
    text.fail(at, out_of_range({word.data(), rest}, vertices));
  }
  const auto found = static_cast<std::uint64_t>(number);
  if (found > vertices && found > forward.number) forward = {found, at};
  return static_cast<Index>(found - 1);
}

}  // namespace

Mesh read_obj(const Input& input) {
  Mesh mesh;
  Text text(input);
  Coordinates coordinates;
  std::vector<Index> corners;
  ForwardReference forward;
  const auto read_corners = [&] {
    text.advance(1);
    corners.clear();
    while (!text.line_ends()) corners.push_back(read_corner(text, coordinates.size(), forward));
  };
  for (std::size_t line = 0; !text.at_end(); ++line, text.next_line()) {
    if (line % 65536 == 0) input.progress(text.at());
    if (text.line_ends()) continue;
    if (text.word_is("v")) {
      text.advance(1);
      const double x = text.number("coordinate x");
      const double y = text.number("coordinate y");
      const double z = text.number("coordinate z");
      coordinates.push(x, y, z);
    } else if (text.word_is("f")) {
      read_corners();
      if (corners.size() >= 3) mesh.faces.push_back(corners);
    } else if (text.word_is("l")) {
      read_corners();
      for (std::size_t k = 1; k < corners.size(); ++k) {
        mesh.marked_edges.push_back({corners[k - 1], corners[k]});
      }
    } else if (mesh.faces.empty() && text.word_is("vn")) {
      text.advance(2);
      const double x = text.number("normal x");
      const double y = text.number("normal y");
      const double z = text.number("normal z");
      mesh.normals.emplace_back(Eigen::Vector3d(x, y, z).cast<float>());
    }
  }
  if (forward.number > coordinates.size()) {
    text.fail(forward.at, out_of_range(std::to_string(forward.number), coordinates.size()));
  }
  coordinates.move_to(mesh, input);
  // In a mesh, normals belong to corners of faces, not to vertices.
  if (!mesh.faces.empty() || mesh.normals.size() != mesh.positions.size()) mesh.normals = {};
  return mesh;
}

void write_obj(Output& output, const Mesh& mesh) {
  output.write("# written by Meshgrain\n");
  const bool shifted = !mesh.origin.isZero(0);
  for (const Vec3& p : mesh.positions) {
    if (shifted) {
      const Eigen::Vector3d q = p.cast<double>() + mesh.origin;
      output.print("v {} {} {}\n", q.x(), q.y(), q.z());
    } else {
      output.print("v {} {} {}\n", p.x(), p.y(), p.z());
    }
  }
  if (mesh.is_point_cloud()) {
    for (const Vec3& n : mesh.normals) output.print("vn {} {} {}\n", n.x(), n.y(), n.z());
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    output.write("f");
    for (const Index v : mesh.faces[f]) output.print(" {}", std::size_t{v} + 1);
    output.write("\n");
  }
}

}  // namespace meshgrain::io
