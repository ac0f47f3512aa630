// Scanalyze's ALN: a list of scans, each a PLY file and the matrix that aligns it.
//
//   2
//   left.ply
//   1 0 0 0.5   (the matrix: four rows, the last of them 0 0 0 1)
//   ...
//   right.ply
//   ...

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <string>

#include "io/coordinates.h"
#include "io/formats.h"
#include "io/text.h"

namespace meshgrain::io {
namespace {

Eigen::Affine3d read_matrix(Text& text, const Item& item) {
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      matrix(row, column) = text.number(item, "a number of a 4 x 4 matrix");
    }
  }
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    text.fail("expected 0 0 0 1 as the last row of the matrix of " + item.text());
  }
  if (!(matrix.topLeftCorner<3, 3>().determinant() > 0)) {
    text.fail(fmt::format("the matrix of {} mirrors or flattens", item.text()));
  }
  return Eigen::Affine3d(matrix);
}

/// Some programs put a lone "0" or "#" between the name and the matrix.
void skip_flag(Text& text) {
  if (text.file_ends()) return;
  Text ahead = text;
  ahead.word();
  if (ahead.line_ends()) text.next_line();
}

/// All but the positions go to `mesh`.
void append(const Mesh& scan, const Eigen::Affine3d& transform, const Input& file,
            Coordinates& coordinates, Mesh& mesh) {
  const std::size_t before = coordinates.size();
  if (before + scan.positions.size() >= no_index) {
    file.fail("the scans hold more vertices than 32 bits can number");
  }
  for (const Vec3& position : scan.positions) {
    const Eigen::Vector3d p = transform * (position.cast<double>() + scan.origin);
    if (!(p.cwiseAbs().maxCoeff() <= std::numeric_limits<float>::max())) {
      file.fail("a vertex is not finite after its transformation");
    }
    coordinates.push(p.x(), p.y(), p.z());
  }
  const Eigen::Matrix3d of_normals = transform.linear().inverse().transpose();
  for (const Vec3& normal : scan.normals) {
    const Eigen::Vector3d n = (of_normals * normal.cast<double>()).stableNormalized();
    mesh.normals.push_back(n.allFinite() ? n.cast<float>() : Vec3(Vec3::Zero()));
  }
  mesh.values.insert(mesh.values.end(), scan.values.begin(), scan.values.end());
  const auto first = static_cast<Index>(before);
  for (const auto& [a, b] : scan.marked_edges) mesh.marked_edges.push_back({first + a, first + b});
  std::vector<Index> face;
  for (std::size_t f = 0; f < scan.faces.size(); ++f) {
    const std::span<const Index> corners = scan.faces[f];
    face.assign(corners.begin(), corners.end());
    for (Index& v : face) v += first;
    mesh.faces.push_back(face);
  }
}

}  // namespace

/// The scans become one mesh, or one point cloud if any of them has no faces.
Mesh read_aln(const Input& input) {
  Text text(input);
  if (text.file_ends()) text.fail("expected the number of scans, found the end of the file");
  const std::uint64_t scans = text.count("the number of scans");
  if (scans == 0) text.fail("the file names no scans");
  text.next_line();

  Mesh mesh;
  Coordinates coordinates;
  bool all_have_faces = true;
  bool all_have_normals = true;
  for (std::uint64_t s = 0; s < scans; ++s) {
    const Item item{"scan", s, scans};
    if (text.file_ends()) text.fail("the file ends before " + item.text());
    const char* const at = text.at();
    const std::string_view name = text.rest_of_line();
    const std::filesystem::path path =
        input.path().parent_path() / std::filesystem::path(std::u8string(name.begin(), name.end()));
    std::error_code ignored;
    if (!exists(path, ignored)) {
      text.fail(at, fmt::format("the scan {} does not exist", in_quotes(name)));
    }
    text.next_line();
    skip_flag(text);
    const Eigen::Affine3d transform = read_matrix(text, item);
    text.next_line();

    const double all = static_cast<double>(scans);
    const double done = static_cast<double>(s);
    const Input file(path, input.options(), input.context(), done / all, (done + 1) / all);
    const Mesh scan = read_ply(file);
    all_have_faces &= !scan.faces.empty();
    all_have_normals &= !scan.normals.empty();
    append(scan, transform, file, coordinates, mesh);
  }
  if (!all_have_faces) mesh.faces.clear();
  if (!all_have_normals) mesh.normals = {};
  coordinates.move_to(mesh, input);
  return mesh;
}

}  // namespace meshgrain::io
