// STL, text and binary (little endian). Its triangles share no vertices: they are welded.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "io/coordinates.h"
#include "io/formats.h"
#include "io/text.h"
#include "mesh/weld.h"

namespace meshgrain::io {
namespace {

constexpr std::size_t header_bytes = 80;
constexpr std::size_t triangle_bytes = 50;  // normal, three corners, two bytes of attributes

template <class T>
T load(const char* at) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// The size of a binary file follows from its count. No text has a count that fits its size: it
/// would be above 150 million.
bool has_binary_size(std::string_view bytes) {
  if (bytes.size() < header_bytes + 4) return false;
  const std::uint64_t count = load<std::uint32_t>(bytes.data() + header_bytes);
  return bytes.size() == header_bytes + 4 + count * triangle_bytes;
}

bool begins_with_solid(std::string_view bytes) {
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  constexpr std::string_view solid = "solid";
  return is_same_word(bytes.substr(0, solid.size()), solid) &&
         (bytes.size() == solid.size() || bytes[solid.size()] <= ' ');
}

/// Binary files may begin with "solid" too, but hold zeros soon.
bool looks_like_text(std::string_view bytes) {
  return begins_with_solid(bytes) && bytes.substr(0, 1024).find('\0') == bytes.npos;
}

void read_binary(const Input& input, DistinctPositions& vertices, Faces& faces) {
  const std::string_view bytes = input.bytes();
  if (bytes.size() < header_bytes + 4) {
    input.fail_at_byte(input.end(), "the file ends within its header of 84 bytes");
  }
  const std::uint64_t count = load<std::uint32_t>(bytes.data() + header_bytes);
  const char* at = input.begin() + header_bytes + 4;
  const std::uint64_t whole = (bytes.size() - header_bytes - 4) / triangle_bytes;
  if (whole < count) {
    input.fail_at_byte(input.end(),
                       "the file ends within " + Item{"triangle", whole, count}.text());
  }
  if (whole > count) {
    input.fail_at_byte(
        at + count * triangle_bytes,
        fmt::format("the header counts {} triangles, but {} bytes follow these", count,
                    bytes.size() - header_bytes - 4 - count * triangle_bytes));
  }
  faces.reserve(count, 3 * count);
  for (std::uint64_t t = 0; t < count; ++t, at += triangle_bytes) {
    if (t % 65536 == 0) input.progress(at);
    std::array<Index, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const char* const corner = at + 12 * (c + 1);
      const Vec3 p(load<float>(corner), load<float>(corner + 4), load<float>(corner + 8));
      if (!p.allFinite()) {
        input.fail_at_byte(corner,
                           "a coordinate is not finite in " + Item{"triangle", t, count}.text());
      }
      corners[c] = vertices.add(p);
    }
    faces.push_back(corners);
  }
}

/// Every face gets vertices of its own: which are the same is to be seen when they have lost what
/// single precision cannot hold, but no more than that.
void read_text(const Input& input, Coordinates& corners, Faces& faces) {
  Text text(input);
  const auto is = [&](std::string_view name) { return text.word_is_in_any_case(name); };
  std::vector<Index> face;
  bool in_solid = false;
  bool in_loop = false;
  for (std::size_t line = 0; !text.file_ends(); ++line) {
    if (line % 65536 == 0) input.progress(text.at());
    if (in_loop) {
      if (is("vertex")) {
        text.advance(6);
        const double x = text.number("coordinate x");
        const double y = text.number("coordinate y");
        const double z = text.number("coordinate z");
        face.push_back(static_cast<Index>(corners.size()));
        corners.push(x, y, z);
      } else if (is("endloop")) {
        text.advance(7);
        if (face.size() >= 3) faces.push_back(face);
        face.clear();
        in_loop = false;
      } else {
        const char* const at = text.at();
        text.fail(at, "expected \"vertex\" or \"endloop\", found " + in_quotes(text.word()));
      }
    } else if (is("solid") || is("endsolid")) {  // a name may follow
      in_solid = is("solid");
      text.next_line();
    } else {  // all else, such as the normals, follows from the corners
      in_loop = is("loop");
      text.word();
    }
  }
  if (in_loop) text.fail("the file ends within a facet");
  if (in_solid) text.fail("the file ends without \"endsolid\"");
}

}  // namespace

bool is_stl(std::string_view bytes) {
  return has_binary_size(bytes) || begins_with_solid(bytes);
}

Mesh read_stl(const Input& input) {
  Mesh mesh;
  Coordinates coordinates;
  DistinctPositions vertices;
  const bool is_text = !has_binary_size(input.bytes()) && looks_like_text(input.bytes());
  if (is_text) {
    read_text(input, coordinates, mesh.faces);
  } else {
    read_binary(input, vertices, mesh.faces);
    for (const Vec3& p : vertices.positions()) coordinates.push(p.x(), p.y(), p.z());
  }
  if (mesh.faces.empty()) input.fail("the file holds no triangles");
  coordinates.move_to(mesh, input);
  if (is_text) {
    for (Index& v : mesh.faces.corners()) v = vertices.add(mesh.positions[v]);
    mesh.positions = vertices.take();
  }
  return mesh;
}

void write_stl(Output& output, const Mesh& mesh) {
  if (mesh.is_point_cloud()) {
    output.fail("STL holds triangles only: write points as .ply, .obj or .off");
  }
  std::uint64_t count = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    count += std::max<std::size_t>(mesh.faces.degree(f), 2) - 2;
  }
  if (count > std::numeric_limits<std::uint32_t>::max()) {
    output.fail("STL cannot count so many triangles: write them as .ply or .obj");
  }
  constexpr std::string_view title = "written by Meshgrain";
  output.write(title);
  output.write(std::string(header_bytes - title.size(), '\0'));
  output.put(static_cast<std::uint32_t>(count));

  const Vec3 origin = mesh.origin.cast<float>();
  const auto put_vector = [&](const Vec3& v) {
    for (const float x : v) output.put(x);
  };
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::span<const Index> face = mesh.faces[f];
    const auto position = [&](std::size_t c) -> const Vec3& {
      return mesh.positions[face[c % face.size()]];
    };
    // A fan; that of a quad begins where its shorter diagonal does.
    const bool from_second = face.size() == 4 && (position(3) - position(1)).squaredNorm() <
                                                     (position(2) - position(0)).squaredNorm();
    const std::size_t apex = from_second ? 1 : 0;
    for (std::size_t c = 1; c + 1 < face.size(); ++c) {
      const Vec3& a = position(apex);
      const Vec3& b = position(apex + c);
      const Vec3& d = position(apex + c + 1);
      put_vector((b - a).cross(d - a).stableNormalized());
      for (const Vec3* p : {&a, &b, &d}) put_vector(*p + origin);
      output.put(std::uint16_t{0});
    }
  }
}

}  // namespace meshgrain::io
