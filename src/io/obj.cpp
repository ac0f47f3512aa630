// Wavefront OBJ: positions, faces, the normals of point clouds, and what marks edges: lines,
// materials, and the normals of faces' corners. All else is ignored.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include "io/coordinates.h"
#include "io/formats.h"
#include "io/obj_runs.h"
#include "io/paint.h"
#include "io/text.h"
#include "mesh/border.h"
#include "mesh/join_edges.h"
#include "mesh/split_normals.h"
#include "mesh/weld.h"

namespace meshgrain::io {
namespace {

/// The highest vertex that faces and lines named before it was defined, checked when all of them
/// are known.
struct ForwardReference {
  std::uint64_t number = 0;
  const char* at = nullptr;
};

class Reader {
 public:
  explicit Reader(const Input& input) : input_(input), text_(input) {}

  /// Reads all lines.
  void run() {
    for (std::size_t line = 0; !text_.at_end(); ++line, text_.next_line()) {
      if (line % 65536 == 0) input_.progress(text_.at());
      if (text_.at() >= next_run_) read_runs();
      if (!text_.line_ends()) read_line();
    }
    if (forward_.number > coordinates_.size()) {
      text_.fail(forward_.at, out_of_range(std::to_string(forward_.number), coordinates_.size()));
    }
    coordinates_.move_to(mesh_, input_);
  }

  /// What free-form curves and surfaces go by is no point cloud.
  void refuse_free_form() const {
    if (!has_free_form_ || !mesh_.faces.empty()) return;
    input_.fail("has free-form curves or surfaces, but no faces");
  }

  /// A mesh, whose marked edges are those of lines alone.
  Mesh take() {
    // In a mesh, normals belong to corners of faces, not to vertices.
    if (mesh_.faces.empty() && shading_.normals.size() == mesh_.positions.size()) {
      mesh_.normals = std::move(shading_.normals);
    }
    return std::move(mesh_);
  }

  /// Before edges are marked: the two faces of a hard edge may have vertices of their own there.
  void weld_faces(const Context& context) {
    if (mesh_.faces.empty()) return;
    drop_rounding(mesh_, context);
    weld(mesh_);
  }

  void mark_material_borders() {
    if (materials_.size() < 2) return;
    std::vector<Index> material(mesh_.faces.size(), 0);
    const auto begin = material.begin();
    for (std::size_t use = 0; use < uses_.size(); ++use) {
      const auto from = static_cast<std::ptrdiff_t>(uses_[use].first);
      const bool is_last = use + 1 == uses_.size();
      const auto to =
          is_last ? material.end() : begin + static_cast<std::ptrdiff_t>(uses_[use + 1].first);
      std::fill(begin + from, to, uses_[use].second);
    }
    const auto parts_two = [&](const InnerEdge& edge) {
      return material[edge.left] != material[edge.right];
    };
    for (const InnerEdge& edge : inner_edges(mesh_, parts_two, input_.context())) {
      mesh_.marked_edges.push_back(edge.ends);
    }
  }

  void mark_hard_edges() {
    if (!shading_.corners.empty()) shading_.corners.resize(mesh_.faces.corners().size(), no_index);
    const auto edges = split_edges(mesh_, shading_, input_.context());
    mesh_.marked_edges.insert(mesh_.marked_edges.end(), edges.begin(), edges.end());
  }

 private:
  /// Of lines that are like each other, as long as there are any. What is between them, and short
  /// ones, are read line by line.
  void read_runs() {
    constexpr std::size_t few = 1 << 14;  // bytes
    std::size_t parts = 1, bytes = 0;
    do {
      if (text_.line_ends()) break;
      const char* const before = text_.at();
      read_run(parts);
      input_.progress(text_.at());
      bytes = static_cast<std::size_t>(text_.at() - before);
      parts = bytes >= parts * run_part ? std::min(2 * parts, most_run_parts) : 1;
    } while (bytes > few);
    next_run_ = text_.at() + std::min<std::ptrdiff_t>(few, input_.end() - text_.at());
  }

  void read_run(std::size_t parts) {
    if (text_.word_is("v") && !input_.options().paint) {
      for (const ObjNumbers& part : read_run_of_numbers(text_, "v", parts, input_)) {
        for (const auto& [x, y, z] : part) coordinates_.push(x, y, z);
      }
    } else if (text_.word_is("vn")) {
      for (const ObjNumbers& part : read_run_of_numbers(text_, "vn", parts, input_)) {
        for (const auto& [x, y, z] : part) {
          shading_.normals.push_back(Eigen::Vector3d(x, y, z).cast<float>());
        }
      }
    } else if (text_.word_is("f")) {
      for (const ObjFaces& part : read_run_of_faces(text_, coordinates_.size(), parts, input_)) {
        add_faces(part);
      }
    }
  }

  void add_faces(const ObjFaces& faces) {
    if (!faces.normals.empty()) {
      shading_.corners.resize(mesh_.faces.corners().size(), no_index);
      shading_.corners.insert(shading_.corners.end(), faces.normals.begin(), faces.normals.end());
    }
    std::span<const Index> corners = faces.corners;
    for (std::size_t f = 0; f < faces.degrees.size();) {
      const Index degree = faces.degrees[f];
      std::size_t alike = 0;
      while (f < faces.degrees.size() && faces.degrees[f] == degree) ++f, ++alike;
      mesh_.faces.append(corners.first(alike * degree), degree);
      corners = corners.subspan(alike * degree);
    }
  }

  void read_line() {
    if (text_.word_is("v")) {
      text_.advance(1);
      const double x = text_.number("coordinate x");
      const double y = text_.number("coordinate y");
      const double z = text_.number("coordinate z");
      coordinates_.push(x, y, z);
      if (input_.options().paint) read_paint();
    } else if (text_.word_is("f")) {
      read_corners();
      if (corners_.size() >= 3) add_face();
    } else if (text_.word_is("l")) {
      read_corners();
      for (std::size_t k = 1; k < corners_.size(); ++k) {
        mesh_.marked_edges.push_back({corners_[k - 1], corners_[k]});
      }
    } else if (text_.word_is("vn")) {
      text_.advance(2);
      read_normal();
    } else if (text_.word_is("usemtl")) {
      text_.advance(6);
      // Faces before the first have a material without a name.
      if (materials_.empty() && !mesh_.faces.empty()) materials_.emplace("", 0);
      const auto number = static_cast<Index>(materials_.size());
      const auto material = materials_.try_emplace(text_.rest_of_line(), number).first;
      uses_.emplace_back(mesh_.faces.size(), material->second);
    } else if (text_.word_is("cstype")) {
      has_free_form_ = true;
    }
  }

  /// They need not be good ones, which programs make of faces that have no area: normals may be
  /// missing as well.
  void read_normal() {
    Eigen::Vector3d n = Eigen::Vector3d::Zero();
    if (mesh_.faces.empty()) {
      n.x() = text_.number_or_nan("normal x");
      n.y() = text_.number_or_nan("normal y");
      n.z() = text_.number_or_nan("normal z");
      if (!n.allFinite()) n.setZero();
    } else if (!text_.try_number(n.x()) || !text_.try_number(n.y()) || !text_.try_number(n.z())) {
      n.setZero();
    }
    shading_.normals.push_back(n.cast<float>());
  }

  /// The colour after a position: three numbers from 0 to 1.
  void read_paint() {
    const double red = text_.number("the vertex's red, from 0 to 1");
    const double green = text_.number("the vertex's green");
    const double blue = text_.number("the vertex's blue");
    mesh_.values.push_back(paint_of(red, green, blue));
  }

  void read_corners() {
    text_.advance(1);
    corners_.clear();
    corner_normals_.clear();
    while (!text_.line_ends()) read_corner();
  }

  /// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn`, vertices and normals counted from 1. Negative numbers
  /// count back from the latest.
  void read_corner() {
    const std::size_t vertices = coordinates_.size();
    const char* const at = text_.at();
    const std::string_view word = text_.word();
    const ObjCorner corner = parse_corner(word);
    if (corner.kind == ObjCorner::Kind::no_number) {
      text_.fail(at, fmt::format("expected a vertex index, found {}", in_quotes(word)));
    }
    std::int64_t number = corner.vertex;
    if (number < 0) number += static_cast<std::int64_t>(vertices) + 1;
    if (corner.kind == ObjCorner::Kind::out_of_range || number < 1 || number >= no_index) {
      text_.fail(at, out_of_range(corner.name, vertices));
    }
    const auto found = static_cast<std::uint64_t>(number);
    if (found > vertices && found > forward_.number) forward_ = {found, at};
    corners_.push_back(static_cast<Index>(found - 1));
    corner_normals_.push_back(normal_of(corner));
  }

  /// It may be none: that is no error.
  Index normal_of(const ObjCorner& corner) const {
    std::int64_t number = corner.normal;
    if (number < 0) number += static_cast<std::int64_t>(shading_.normals.size()) + 1;
    return number >= 1 && number < no_index ? static_cast<Index>(number - 1) : no_index;
  }

  void add_face() {
    const bool shaded = std::any_of(corner_normals_.begin(), corner_normals_.end(),
                                    [](Index n) { return n != no_index; });
    if (shaded) {
      shading_.corners.resize(mesh_.faces.corners().size(), no_index);
      shading_.corners.insert(shading_.corners.end(), corner_normals_.begin(),
                              corner_normals_.end());
    }
    mesh_.faces.push_back(corners_);
  }

  const Input& input_;
  Text text_;
  const char* next_run_ = text_.at();  // where one may begin
  Mesh mesh_;
  Coordinates coordinates_;
  ForwardReference forward_;
  std::vector<Index> corners_, corner_normals_;  // of the line that is being read
  CornerNormals shading_;
  std::map<std::string_view, Index> materials_;
  std::vector<std::pair<std::size_t, Index>> uses_;  // of materials, each from a face on
  bool has_free_form_ = false;
};

}  // namespace

Mesh read_obj(const Input& input) {
  Reader reader(input);
  reader.run();
  reader.refuse_free_form();
  if (input.options().weld) reader.weld_faces(input.context());
  reader.mark_material_borders();
  reader.mark_hard_edges();
  return reader.take();
}

Mesh read_obj_lines(const Input& input) {
  Reader reader(input);
  reader.run();
  return reader.take();
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
  const Polylines lines = join_edges(mesh.marked_edges, mesh.positions.size());
  for (std::size_t line = 0; line < lines.size(); ++line) {
    output.write("l");
    for (Index k = lines.begin(line); k < lines.end(line); ++k) {
      output.print(" {}", std::size_t{lines.vertices[k]} + 1);
    }
    output.write("\n");
  }
}

}  // namespace meshgrain::io
