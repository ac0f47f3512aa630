#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "io/formats.h"
#include "io/ply.h"

namespace meshgrain::io {

void write_ply(Output& output, const Mesh& mesh) {
  ply::write(output, mesh, {}, {});
}

namespace ply {

void write(Output& output, const Mesh& mesh, std::span<const std::string> comments,
           std::span<const Attribute> attributes) {
  const bool shifted = !mesh.origin.isZero(0);
  const bool normals = !mesh.normals.empty();
  std::size_t highest_degree = mesh.faces.uniform_degree();
  for (std::size_t f = 0; f < mesh.faces.size() && mesh.faces.uniform_degree() == 0; ++f) {
    highest_degree = std::max(highest_degree, mesh.faces.degree(f));
  }
  const bool long_lists = highest_degree > std::numeric_limits<std::uint8_t>::max();
  const bool large = mesh.positions.size() > std::numeric_limits<std::int32_t>::max();

  output.print("ply\nformat binary_little_endian 1.0\ncomment written by Meshgrain\n");
  for (const std::string& comment : comments) output.print("comment {}\n", comment);
  output.print("element vertex {}\n", mesh.positions.size());
  for (const char* name : {"x", "y", "z"}) {
    output.print("property {} {}\n", shifted ? "double" : "float", name);
  }
  if (normals) output.write("property float nx\nproperty float ny\nproperty float nz\n");
  for (const Attribute& attribute : attributes) {
    output.print("property {} {}\n", attribute.offset != 0 ? "double" : "float", attribute.name);
  }
  if (!mesh.is_point_cloud()) {
    output.print("element face {}\nproperty list {} {} vertex_indices\n", mesh.faces.size(),
                 long_lists ? "uint" : "uchar", large ? "uint" : "int");
  }
  if (!mesh.marked_edges.empty()) {
    const char* const type = large ? "uint" : "int";
    output.print("element edge {}\nproperty {} vertex1\nproperty {} vertex2\n",
                 mesh.marked_edges.size(), type, type);
  }
  output.write("end_header\n");

  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    for (int i = 0; i < 3; ++i) {
      if (shifted) {
        output.put(static_cast<double>(p[i]) + mesh.origin[i]);
      } else {
        output.put(p[i]);
      }
    }
    if (normals) {
      for (const float n : mesh.normals[v]) output.put(n);
    }
    for (const Attribute& attribute : attributes) {
      const float number = attribute.first[v * attribute.stride];
      if (attribute.offset != 0) {
        output.put(static_cast<double>(number) + attribute.offset);
      } else {
        output.put(number);
      }
    }
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::span<const Index> face = mesh.faces[f];
    if (long_lists) {
      output.put(static_cast<std::uint32_t>(face.size()));
    } else {
      output.put(static_cast<std::uint8_t>(face.size()));
    }
    for (const Index v : face) output.put(v);
  }
  for (const auto& edge : mesh.marked_edges) {
    for (const Index v : edge) output.put(v);
  }
}

}  // namespace ply
}  // namespace meshgrain::io
