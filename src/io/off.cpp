// Geomview's Object File Format, in text and binary (big endian): positions, normals and faces.
// Colours and texture coordinates are skipped.

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "io/coordinates.h"
#include "io/formats.h"
#include "io/text.h"

namespace meshgrain::io {
namespace {

/// What the letters before OFF say that a vertex has besides a position.
struct Header {
  bool texture = false;          // ST
  bool colour = false;           // C
  bool normal = false;           // N
  bool other_dimension = false;  // 4 or n: not points in space
  std::size_t length = 0;
};

std::optional<Header> parse_header(std::string_view text) {
  Header header;
  std::string_view rest = text;
  const auto take = [&rest](std::string_view prefix) {
    const bool found = rest.starts_with(prefix);
    if (found) rest.remove_prefix(prefix.size());
    return found;
  };
  header.texture = take("ST");
  header.colour = take("C");
  header.normal = take("N");
  header.other_dimension = take("4");
  header.other_dimension |= take("n");
  // Some files lack the space before the counts: "OFF490 518 0".
  const auto may_follow = [](char c) { return c <= ' ' || c == '#' || (c >= '0' && c <= '9'); };
  if (!take("OFF") || !(rest.empty() || may_follow(rest.front()))) return std::nullopt;
  header.length = text.size() - rest.size();
  return header;
}

Mesh read_text(const Input& input, Text& text, const Header& header) {
  if (text.file_ends()) text.fail("expected the number of vertices, found the end of the file");
  const std::uint64_t vertices = text.count("the number of vertices");
  const std::uint64_t faces = text.count("the number of faces");
  text.next_line();  // skips the number of edges, which nobody keeps

  // What follows the numbers that are wanted, up to the end of the line, is colours and the like.
  Mesh mesh;
  Coordinates coordinates;
  const auto left = static_cast<std::size_t>(input.end() - text.at());
  coordinates.reserve(plausible(vertices, left, 6));
  for (std::uint64_t v = 0; v < vertices; ++v, text.next_line()) {
    if (v % 65536 == 0) input.progress(text.at());
    const Item item{"vertex", v, vertices};
    const double x = text.number(item, "coordinate x");
    const double y = text.number(item, "coordinate y");
    const double z = text.number(item, "coordinate z");
    coordinates.push(x, y, z);
    if (header.normal) {
      const double nx = text.number(item, "normal x");
      const double ny = text.number(item, "normal y");
      const double nz = text.number(item, "normal z");
      mesh.normals.emplace_back(Eigen::Vector3d(nx, ny, nz).cast<float>());
    }
  }
  std::vector<Index> face;
  for (std::uint64_t f = 0; f < faces; ++f, text.next_line()) {
    if (f % 65536 == 0) input.progress(text.at());
    const Item item{"face", f, faces};
    if (text.file_ends()) text.fail("the file ends within " + item.text());
    const std::uint64_t corners = text.count("the number of corners");
    face.clear();
    for (std::uint64_t c = 0; c < corners; ++c) {
      if (text.file_ends()) text.fail("the file ends within " + item.text());
      const char* const at = text.at();
      const std::uint64_t index = text.count("a vertex index");
      if (index >= vertices) text.fail(at, out_of_range(std::to_string(index), vertices));
      face.push_back(static_cast<Index>(index));
    }
    if (face.size() >= 3) mesh.faces.push_back(face);
  }
  coordinates.move_to(mesh, input);
  return mesh;
}

/// Reads big-endian numbers of 32 bits.
class Binary {
 public:
  Binary(const Input& input, const char* begin) : input_(input), at_(begin) {}

  const char* at() const { return at_; }
  std::size_t left() const { return static_cast<std::size_t>(input_.end() - at_); }

  std::int32_t integer(const Item& item) { return std::bit_cast<std::int32_t>(word(item)); }
  std::uint64_t count(const Item& item) {
    const std::int32_t value = integer(item);
    if (value < 0) fail_at_last(fmt::format("expected a count, found {}", value));
    return static_cast<std::uint64_t>(value);
  }
  float number(const Item& item) {
    const auto value = std::bit_cast<float>(word(item));
    if (!std::isfinite(value)) fail_at_last("a number is not finite in " + item.text());
    return value;
  }
  void skip(std::uint64_t words, const Item& item) {
    if (words > left() / 4) fail_at_end(item);
    at_ += 4 * words;
  }
  [[noreturn]] void fail_at_last(const std::string& what) const {
    input_.fail_at_byte(at_ - 4, what);
  }
  [[noreturn]] void fail_at_end(const Item& item) const {
    input_.fail_at_byte(input_.end(), "the file ends within " + item.text());
  }

 private:
  std::uint32_t word(const Item& item) {
    if (left() < 4) fail_at_end(item);
    std::array<unsigned char, 4> b;
    std::memcpy(b.data(), at_, 4);
    at_ += 4;
    return std::uint32_t{b[0]} << 24 | std::uint32_t{b[1]} << 16 | std::uint32_t{b[2]} << 8 | b[3];
  }

  const Input& input_;
  const char* at_;
};

Mesh read_binary(const Input& input, const char* begin, const Header& header) {
  Binary binary(input, begin);
  const std::uint64_t vertices = binary.count({"count", 0, 3});
  const std::uint64_t faces = binary.count({"count", 1, 3});
  binary.skip(1, {"count", 2, 3});  // edges

  Mesh mesh;
  Coordinates coordinates;
  coordinates.reserve(plausible(vertices, binary.left(), 12));
  for (std::uint64_t v = 0; v < vertices; ++v) {
    if (v % 65536 == 0) input.progress(binary.at());
    const Item item{"vertex", v, vertices};
    const float x = binary.number(item);
    const float y = binary.number(item);
    const float z = binary.number(item);
    coordinates.push(x, y, z);
    if (header.normal) {
      const float nx = binary.number(item);
      const float ny = binary.number(item);
      const float nz = binary.number(item);
      mesh.normals.emplace_back(nx, ny, nz);
    }
    binary.skip((header.colour ? 4u : 0u) + (header.texture ? 2u : 0u), item);
  }
  std::vector<Index> face;
  for (std::uint64_t f = 0; f < faces; ++f) {
    if (f % 65536 == 0) input.progress(binary.at());
    const Item item{"face", f, faces};
    const std::uint64_t corners = binary.count(item);
    if (corners > binary.left() / 4) binary.fail_at_end(item);
    face.clear();
    for (std::uint64_t c = 0; c < corners; ++c) {
      const std::int32_t index = binary.integer(item);
      if (index < 0 || static_cast<std::uint64_t>(index) >= vertices) {
        binary.fail_at_last(out_of_range(std::to_string(index), vertices));
      }
      face.push_back(static_cast<Index>(index));
    }
    if (face.size() >= 3) mesh.faces.push_back(face);
    binary.skip(binary.count(item), item);  // its colour
  }
  coordinates.move_to(mesh, input);
  return mesh;
}

}  // namespace

bool is_off(std::string_view bytes) {
  return parse_header(bytes).has_value();
}

Mesh read_off(const Input& input) {
  Text text(input);
  if (text.file_ends()) text.fail("expected \"OFF\", found the end of the file");
  // The word itself may be left out.
  const Header header = parse_header({text.at(), input.end()}).value_or(Header());
  if (header.other_dimension) text.fail("only points in space can be read, neither 4OFF nor nOFF");
  text.advance(header.length);
  if (!text.line_ends() && text.word_is("BINARY")) {
    text.next_line();
    return read_binary(input, text.at(), header);
  }
  return read_text(input, text, header);
}

void write_off(Output& output, const Mesh& mesh) {
  const bool shifted = !mesh.origin.isZero(0);
  const bool normals = !mesh.normals.empty();
  output.print("{}OFF\n{} {} 0\n", normals ? "N" : "", mesh.positions.size(), mesh.faces.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    if (shifted) {
      const Eigen::Vector3d q = p.cast<double>() + mesh.origin;
      output.print("{} {} {}", q.x(), q.y(), q.z());
    } else {
      output.print("{} {} {}", p.x(), p.y(), p.z());
    }
    if (normals) {
      const Vec3& n = mesh.normals[v];
      output.print(" {} {} {}", n.x(), n.y(), n.z());
    }
    output.write("\n");
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    output.print("{}", mesh.faces.degree(f));
    for (const Index v : mesh.faces[f]) output.print(" {}", v);
    output.write("\n");
  }
}

}  // namespace meshgrain::io
