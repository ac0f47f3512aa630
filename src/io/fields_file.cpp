#include "meshgrain/fields_file.h"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cloud/cloud_normals.h"
#include "io/formats.h"
#include "io/input.h"
#include "io/output.h"
#include "io/ply.h"
#include "meshgrain/error.h"
#include "meshgrain/normals.h"
#include "meshgrain/triangulate.h"

namespace meshgrain {
namespace {

constexpr std::string_view signature = "meshgrain fields";

/// The number behind `name` in the comments, if there is one.
std::optional<double> number_in(const std::vector<std::string>& comments, std::string_view name,
                                const io::Input& input) {
  for (const std::string& comment : comments) {
    if (!comment.starts_with(name) || comment.size() <= name.size() ||
        comment[name.size()] != ' ') {
      continue;
    }
    const std::size_t at = comment.find_first_not_of(' ', name.size());
    double value = 0;
    const auto end = comment.data() + comment.size();
    const auto [after, error] = fast_float::from_chars(comment.data() + at, end, value);
    constexpr double largest = std::numeric_limits<float>::max();
    if (error != std::errc() || after != end || !(std::abs(value) <= largest)) {
      input.fail(fmt::format("the header's comment {} is not a number", io::in_quotes(comment)));
    }
    return value;
  }
  return std::nullopt;
}

/// A symmetry from the comments, which must be one of `known`.
int symmetry_in(const std::vector<std::string>& comments, std::string_view name,
                std::initializer_list<int> known, const io::Input& input) {
  const std::optional<double> value = number_in(comments, name, input);
  if (!value) input.fail(fmt::format("the header has no \"comment {} N\"", name));
  for (const int symmetry : known) {
    if (*value == symmetry) return symmetry;
  }
  input.fail(fmt::format("{} {} is unknown; known are {}", name, *value, fmt::join(known, ", ")));
}

/// Three columns as vectors less `origin`; frees the columns.
std::vector<Vec3> vectors(io::ply::Column* columns, const Eigen::Vector3d& origin) {
  std::vector<Vec3> result(columns[0].numbers.size());
  for (int c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i][c] = static_cast<float>(columns[c].numbers[i] - origin[c]);
    }
    columns[c].numbers = {};
  }
  return result;
}

}  // namespace

void write_fields(const std::filesystem::path& path, const Fields& fields) {
  const Mesh& surface = fields.surface;
  const PositionField& position = fields.position;
  const std::size_t count = surface.positions.size();
  const bool has_positions = !position.points.empty();
  const bool per_node = has_positions && !position.edge_length.uniform();
  if (fields.orientation.directions.size() != count ||
      (has_positions && position.points.size() != count) ||
      (per_node && position.edge_length.values.size() != count)) {
    throw Error(io::display_name(path) +
                ": fields can only be written with one value for each vertex of their surface");
  }

  std::vector<std::string> comments{fmt::format("{} 1", signature),
                                    fmt::format("rosy {}", fields.orientation.rosy)};
  if (has_positions) {
    comments.push_back(fmt::format("posy {}", position.posy));
    if (fields.fine_lattice) comments.emplace_back("fine_lattice 1");
    if (!per_node) comments.push_back(fmt::format("edge_length {}", position.edge_length[0]));
  }
  std::vector<io::ply::Attribute> attributes;
  if (count > 0) {
    const float* const directions = fields.orientation.directions[0].data();
    attributes = {{"ox", directions, 3}, {"oy", directions + 1, 3}, {"oz", directions + 2, 3}};
    if (has_positions) {
      const float* const points = position.points[0].data();
      attributes.push_back({"px", points, 3, surface.origin.x()});
      attributes.push_back({"py", points + 1, 3, surface.origin.y()});
      attributes.push_back({"pz", points + 2, 3, surface.origin.z()});
    }
    if (per_node) attributes.push_back({"length", position.edge_length.values.data()});
  }
  io::Output output(path);
  io::ply::write(output, surface, comments, attributes);
  output.commit();
}

Fields read_fields(const std::filesystem::path& path, const Context& context) {
  const ReadOptions options;
  const io::Input input(path, options, context);
  if (!io::is_ply(input.bytes())) input.fail("is no PLY file, as files of fields are");
  std::array<io::ply::Column, 7> columns;
  constexpr const char* names[] = {"ox", "oy", "oz", "px", "py", "pz", "length"};
  for (std::size_t c = 0; c < columns.size(); ++c) {
    columns[c].name = names[c];
    columns[c].required = c < 3;
  }
  std::vector<std::string> comments;
  Fields fields;
  fields.surface = io::ply::read(input, columns, &comments);
  Mesh& surface = fields.surface;
  if (const auto version = number_in(comments, signature, input); version && *version != 1) {
    input.fail(
        fmt::format("is of version {} of the format; this program knows version 1", *version));
  }

  fields.orientation.rosy = symmetry_in(comments, "rosy", {1, 2, 4, 6}, input);
  fields.orientation.directions = vectors(&columns[0], Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    Vec3& direction = fields.orientation.directions[i];
    // Unit vectors keep their bits.
    if (std::abs(direction.squaredNorm() - 1) > 1e-6f) direction.stableNormalize();
    if (!(direction.squaredNorm() > 0.5f)) {
      input.fail("the orientation has no direction, in " +
                 io::Item{"vertex", i, surface.positions.size()}.text());
    }
  }

  const int found = int{columns[3].found} + int{columns[4].found} + int{columns[5].found};
  if (found != 0 && found != 3) input.fail("has only some of the numbers \"px\", \"py\", \"pz\"");
  if (found == 3) {
    PositionField& position = fields.position;
    position.posy = symmetry_in(comments, "posy", {4, 6}, input);
    position.points = vectors(&columns[3], surface.origin);
    fields.fine_lattice = number_in(comments, "fine_lattice", input) == 1;
    const auto uniform = number_in(comments, "edge_length", input);
    if (columns[6].found) {
      const auto& lengths = columns[6].numbers;
      position.edge_length = EdgeLength(std::vector<float>(lengths.begin(), lengths.end()));
    } else if (uniform) {
      position.edge_length = EdgeLength(static_cast<float>(*uniform));
    } else {
      input.fail("has neither \"comment edge_length\" nor the number \"length\" at its vertices");
    }
    for (const float length : position.edge_length.values) {
      if (!(length > 0)) input.fail(fmt::format("the edge length {} is not positive", length));
    }
  }

  for (Vec3& normal : surface.normals) {
    if (std::abs(normal.squaredNorm() - 1) > 1e-6f) normal.stableNormalize();
  }
  if (!surface.is_point_cloud() && surface.faces.uniform_degree() != 3) {
    surface = triangulate(surface);
  }
  if (surface.is_point_cloud()) {
    surface.normals =
        cloud_normals(surface, nearest_neighbors(surface.positions, 16, context), context);
  } else if (surface.normals.empty()) {
    surface.normals = vertex_normals(surface, -1, context);
  }
  context.progress("read", 1);
  return fields;
}

}  // namespace meshgrain
