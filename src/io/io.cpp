#include "meshgrain/io.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "io/formats.h"
#include "io/input.h"
#include "io/output.h"
#include "io/text.h"
#include "mesh/join_edges.h"
#include "mesh/weld.h"
#include "meshgrain/error.h"
#include "util/platform.h"

namespace meshgrain {
namespace {

struct Format {
  std::string_view extension;
  Mesh (*read)(const io::Input&);
  void (*write)(io::Output&, const Mesh&);     // null if it is only read
  bool (*is_content)(std::string_view bytes);  // null if the content does not tell
  Mesh (*read_lines)(const io::Input&);        // as marked edges; null if it has none
};

// In the order in which contents are tried.
constexpr Format formats[] = {
    {".obj", io::read_obj, io::write_obj, nullptr, io::read_obj_lines},
    {".ply", io::read_ply, io::write_ply, io::is_ply, io::read_ply},
    {".off", io::read_off, io::write_off, io::is_off, nullptr},
    {".stl", io::read_stl, io::write_stl, io::is_stl, nullptr},
    {".aln", io::read_aln, nullptr, nullptr, nullptr},
    {".xyz", io::read_xyz, nullptr, nullptr, nullptr},
    {".pts", io::read_pts, nullptr, nullptr, nullptr},
};

template <class Predicate>
const Format* find_format(const Predicate& predicate) {
  const auto* const found = std::find_if(std::begin(formats), std::end(formats), predicate);
  return found == std::end(formats) ? nullptr : found;
}

bool has_extension(const std::filesystem::path& path, std::string_view extension) {
  const std::u8string own = path.extension().u8string();
  return io::is_same_word({reinterpret_cast<const char*>(own.data()), own.size()}, extension);
}

std::string extensions(bool written_only) {
  std::string list;
  for (const Format& format : formats) {
    if (written_only && !format.write) continue;
    if (!list.empty()) list += ", ";
    list += format.extension;
  }
  return list;
}

const Format& format_of(const io::Input& input) {
  const Format* format =
      find_format([&](const Format& f) { return f.is_content && f.is_content(input.bytes()); });
  if (!format) {
    format = find_format([&](const Format& f) { return has_extension(input.path(), f.extension); });
  }
  if (!format) input.fail("the kind of file is unknown; known are " + extensions(false));
  return *format;
}

const Format& format_to_write(const std::filesystem::path& path) {
  const Format* const format =
      find_format([&](const Format& f) { return f.write && has_extension(path, f.extension); });
  if (!format) {
    throw Error(io::display_name(path) + ": the name must end in one of " + extensions(true));
  }
  return *format;
}

/// Files hold normals with few digits, or of any length. Those that are unit vectors already keep
/// their bits; where there is no direction, zero stays.
void normalize(std::vector<Vec3>& normals) {
  for (Vec3& n : normals) {
    if (std::abs(n.squaredNorm() - 1) > 1e-6f) n.stableNormalize();
  }
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path, const ReadOptions& options,
               const Context& context) {
  const io::Input input(path, options, context);
  Mesh mesh = format_of(input).read(input);
  if (!options.value_name.empty() && mesh.values.empty()) {
    input.fail("only PLY files have named numbers, such as " + io::in_quotes(options.value_name));
  }
  if (mesh.is_point_cloud()) mesh.marked_edges = {};
  if (options.paint && mesh.values.empty()) {
    input.fail("only PLY and OBJ files have colours at their vertices");
  }
  normalize(mesh.normals);
  if (options.weld) {
    drop_rounding(mesh, context);
    weld(mesh);
  }
  context.progress("read", 1);
  return mesh;
}

Polylines read_polylines(const std::filesystem::path& path, const Context& context) {
  const ReadOptions options;
  const io::Input input(path, options, context);
  const Format& format = format_of(input);
  if (!format.read_lines) input.fail("only OBJ and PLY files have lines");
  const Mesh mesh = format.read_lines(input);
  Polylines lines = join_edges(mesh.marked_edges, mesh.positions.size());
  if (lines.empty()) input.fail("has no lines: OBJ has them as \"l\", PLY as the element \"edge\"");
  for (const Vec3& p : mesh.positions) lines.points.push_back(p.cast<double>() + mesh.origin);
  context.progress("read", 1);
  return lines;
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh) {
  const Format& format = format_to_write(path);
  io::Output output(path);
  format.write(output, mesh);
  output.commit();
}

bool holds_triangles_only(const std::filesystem::path& path) {
  return format_to_write(path).write == io::write_stl;
}

void check_writable(const std::filesystem::path& path) {
  format_to_write(path);
  check_place(path);
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  io::Output output(path);
  output.write(bytes);
  output.commit();
}

void check_place(const std::filesystem::path& path) {
  // Who reads from a pipe would take its being opened and closed for the end.
  if (platform::is_stream(path)) return;
  const io::Output probe(path);  // creates a temporary file and removes it again
}

}  // namespace meshgrain
