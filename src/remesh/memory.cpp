#include "remesh/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "mesh/surface_size.h"
#include "meshgrain/error.h"
#include "remesh/target.h"
#include "util/sum.h"

namespace meshgrain {
namespace {

// In bytes, fitted to measured runs (Cli.MemoryIsEstimatedFromAbove holds them to it).
constexpr double program = 13 << 20, thread = 1 << 20;
constexpr double node_of_vertex = 330, node_of_face = 260;  // with its part of all levels
constexpr double coarse_levels = 60;  // of the former: they go where no count was asked for
// More, in cells of so many vertices, many of which collapse one by one.
constexpr double node_of_large_cell = 130, large_cell = 500;
constexpr double point = 170, neighbor = 17;  // of a cloud, each of its neighbours
constexpr double dense_point = 60;            // more, until thin_out() has passed
constexpr double input_vertex = 12, input_corner = 4;
constexpr double dense_vertex = 90;  // more, until coarsen() has passed
constexpr double written_corner = 65;
constexpr double given_node = 250;  // of RemeshOptions::fields

/// Into how many triangles subdivide() splits one with edges of these lengths: each edge is halved
/// until it is short enough. All three at once make four triangles, and what is left when the
/// shortest is done is a strip.
double pieces(std::array<double, 3> edges, double limit) {
  std::ranges::sort(edges, std::greater());
  std::array<double, 3> parts;
  for (std::size_t k = 0; k < 3; ++k) {
    parts[k] = std::exp2(std::max(0.0, std::ceil(std::log2(edges[k] / limit))));
  }
  return parts[2] * (parts[0] + parts[1] - parts[2]);
}

/// How many triangles there are when none of their edges is longer than `limit`.
double triangles_within(const Mesh& mesh, double limit, const Context& context) {
  return sum_over_ranges(
      mesh.faces.size(),
      [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t f = begin; f < end; ++f) {
          const auto face = mesh.faces[f];
          const auto length = [&](std::size_t a, std::size_t b) {
            return double{(mesh.positions[face[a]] - mesh.positions[face[b]]).norm()};
          };
          for (std::size_t k = 2; k < face.size(); ++k) {
            sum += pieces({length(0, k - 1), length(k - 1, k), length(k, 0)}, limit);
          }
        }
        return sum;
      },
      context);
}

/// By how many triangles the mesh grows that the fields live on.
double added_triangles(const Mesh& input, double triangles, const SurfaceSize& size,
                       const Target& target, const RemeshOptions& options, const Context& context) {
  const double limit = target.longest_input_edge(options, size.area, size.edges.mean);
  if (!(limit > 0)) return 0;
  const double added = std::max(0.0, triangles_within(input, limit, context) - triangles);
  // Later on only those are split where small faces are wanted.
  constexpr double triangles_in_cell = 6;
  const double length = target.edge_length(size.area);
  const bool again = !options.sizing.is_uniform() && !splits_only_once(options);
  return again ? added + triangles_in_cell * size.area / (length * length) : added;
}

double bytes_of_written_face(const RemeshOptions& options) {
  if (options.faces == OutputFaces::triangles) return 3 * written_corner;
  // The dual of two triangles, which are there first.
  if (options.faces == OutputFaces::hexagons) return 12 * written_corner;
  return 4 * written_corner;
}

/// Bytes at any target, and those that this one takes besides.
struct Need {
  double input = 0, target = 0;
};

Need needed_by_cloud(const Mesh& input, const RemeshOptions& options, const Target& target) {
  const auto points = static_cast<double>(input.positions.size());
  const double written = options.edge_length > 0 ? points : 1 / target.face_area(1);
  const double node = point + neighbor * static_cast<double>(options.graph.neighbors);
  const double faces = written * bytes_of_written_face(options);
  const double enough = target.density_of_cloud(options).points;
  constexpr double most = 5;  // times as many as are enough are left
  if (target.may_be_dense(options, input.positions.size()) && points > most * enough &&
      enough > 0) {
    const double before = points * dense_point;
    return {before, std::max(0.0, most * enough * node + faces - before)};
  }
  return {points * node, std::max(0.0, enough - points) * node + faces};
}

/// The fields, and what comes of them, over a surface of so many vertices: the second are `added`.
Need needed_by_nodes(double vertices, double added, double area, const RemeshOptions& options,
                     const Target& target) {
  const double length = target.edge_length(area);
  const bool is_large = (vertices + added) * length * length > large_cell * area;
  const double node = node_of_vertex - (target.must_be_met() ? 0 : coarse_levels) +
                      (is_large ? node_of_large_cell : 0);
  const double written = area / target.face_area(area) * bytes_of_written_face(options);
  return {vertices * node, added * node + written};
}

/// Either many vertices, or the fields over the few that are left of them.
Need needed_by_dense_mesh(double vertices, const SurfaceSize& size, const RemeshOptions& options,
                          const Target& target) {
  constexpr double nodes_in_shortest_square = 0.75;  // measured
  const double shortest = target.coarse_edges(options, size.area).shortest;
  const double nodes =
      std::min(vertices, nodes_in_shortest_square * size.area / (shortest * shortest));
  const Need fields = needed_by_nodes(nodes, 0, size.area, options, target);
  const double before = vertices * dense_vertex;
  return {before, std::max(0.0, fields.input + fields.target - before)};
}

Need needed_by_mesh(const Mesh& input, const RemeshOptions& options, const Target& target,
                    const Context& context) {
  const SurfaceSize size = surface_size(input, context);
  const double area = size.area;
  if (!(area > 0)) return {};
  const auto vertices = static_cast<double>(input.positions.size());
  const double triangles = static_cast<double>(input.faces.corners().size()) -
                           2 * static_cast<double>(input.faces.size());
  if (target.is_dense(options, input.positions.size(), size))
    return needed_by_dense_mesh(vertices, size, options, target);
  const double added = added_triangles(input, triangles, size, target, options, context);
  // Two triangles come with each vertex that is put between others.
  if (options.graph.nodes == GraphNodes::vertices) {
    return needed_by_nodes(vertices, added / 2, area, options, target);
  }
  const double written = area / target.face_area(area) * bytes_of_written_face(options);
  return {triangles * node_of_face, added * node_of_face + written};
}

Need needed(const Mesh& input, const RemeshOptions& options, const Context& context) {
  const std::size_t by_default =
      default_vertex_count(input.positions.size(), input.is_point_cloud());
  const Target target(options, options.faces, by_default, 1);
  Need need = input.is_point_cloud() ? needed_by_cloud(input, options, target)
                                     : needed_by_mesh(input, options, target, context);
  need.input += program + thread * context.threads() +
                static_cast<double>(input.positions.size()) * input_vertex +
                static_cast<double>(input.faces.corners().size()) * input_corner;
  if (options.fields != nullptr) {
    need.input += given_node * static_cast<double>(options.fields->surface.positions.size());
  }
  return need;
}

/// "1.5 GiB", rounded up or down.
std::string amount(double bytes, double (*round)(double)) {
  constexpr double mib = 1 << 20, gib = 1 << 30;
  if (bytes < mib) return fmt::format("{:.0f} bytes", bytes);
  return bytes < gib ? fmt::format("{:.0f} MiB", round(bytes / mib))
                     : fmt::format("{:.1f} GiB", round(10 * bytes / gib) / 10);
}

void refuse_more_than_limit(const Need& need, const RemeshOptions& options) {
  const auto limit = static_cast<double>(options.memory_limit);
  if (need.input + need.target <= limit) return;
  const char* const less = need.input > limit        ? "take a coarser input"
                           : options.edge_length > 0 ? "ask for longer edges"
                                                     : "ask for fewer faces";
  throw Error(
      fmt::format("this may take {} of memory, more than the limit of {}: {}, or allow more",
                  amount(need.input + need.target, std::ceil), amount(limit, std::floor), less));
}

}  // namespace

bool check_memory(const Mesh& input, const RemeshOptions& options, const Context& context) {
  if (options.memory_limit == 0) return true;
  const Need need = needed(input, options, context);
  refuse_more_than_limit(need, options);
  // Of parts that are made over several times, with many pairs of faces that pass through each
  // other, the worst took 3.5 times as much.
  constexpr double worst = 4;
  return worst * (need.input + need.target) <= static_cast<double>(options.memory_limit);
}

void check_memory_of_coarse(const Mesh& surface, double area, const RemeshOptions& options,
                            const Target& target, const Context& context) {
  if (options.memory_limit == 0) return;
  const auto vertices = static_cast<double>(surface.positions.size());
  Need need = needed_by_nodes(vertices, 0, area, options, target);
  need.input += program + thread * context.threads();
  refuse_more_than_limit(need, options);
}

}  // namespace meshgrain
