#include "remesh/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "mesh/edges.h"
#include "meshgrain/error.h"

namespace meshgrain {
namespace {

/// The shortest length of an edge, as a share of the mean one.
double smallest_share(const RemeshOptions& options) {
  return options.sizing.is_uniform() ? 1 : 1 / options.sizing.ratio;
}

}  // namespace

int posy_of(OutputFaces faces) {
  return faces == OutputFaces::triangles || faces == OutputFaces::hexagons ? 6 : 4;
}

std::size_t default_vertex_count(std::size_t input_vertices, bool is_cloud) {
  constexpr std::size_t enough = 500;
  return std::max(input_vertices / 16, is_cloud ? std::min(input_vertices, enough) : enough);
}

Target::Target(const RemeshOptions& options, OutputFaces lattice_faces,
               std::size_t default_vertices, double scale) {
  // A cell of the triangular lattice is two triangles, or one vertex; of its dual, two vertices or
  // one hexagon. A pure quad mesh has four quads, and four vertices, for each of the lattice's
  // before its split.
  if (posy_of(lattice_faces) == 6) cell_area_ = std::sqrt(3.0) / 2;
  kind_ = lattice_faces;
  const bool split = lattice_faces == OutputFaces::quads;
  const bool dual = lattice_faces == OutputFaces::hexagons;
  sides_ = split ? 2 : 1;
  faces_per_cell_ = split ? 4 : lattice_faces == OutputFaces::triangles ? 2 : 1;
  const double vertices_per_cell = split ? 4 : dual ? 2 : 1;
  if (options.edge_length > 0) {
    // The edge of a hexagon is the triangles' divided by the root of three.
    length_ = options.edge_length * (split ? 2 : dual ? std::sqrt(3.0) : 1) / scale;
  } else if (options.face_count > 0) {
    faces_ = static_cast<double>(options.face_count);
    cells_ = faces_ / faces_per_cell_;
  } else if (options.vertex_count == 0 && has_given_positions(options)) {
    const std::vector<float>& lengths = options.fields->position.edge_length.values;
    const double sum = std::accumulate(lengths.begin(), lengths.end(), 0.0);
    length_ = sum / static_cast<double>(lengths.size()) / scale;
  } else {
    is_asked_for_ = options.vertex_count > 0;
    vertices_ = static_cast<double>(is_asked_for_ ? options.vertex_count : default_vertices);
    cells_ = vertices_ / vertices_per_cell;
  }
}

double Target::edge_length(double area) const {
  return cells_ > 0 ? std::sqrt(area / (cells_ * cell_area_)) : length_;
}

double Target::face_area(double area) const {
  const double length = edge_length(area);
  return length * length * cell_area_ / faces_per_cell_;
}

void Target::refuse_too_many(double area) const {
  constexpr double most = 1e9;  // with four corners each, of which 2^32 can be told apart
  const double faces = area / face_area(area);
  if (!(faces > most)) return;
  throw Error(fmt::format("this asks for about {:.2g} faces, more than {:.0f}: {}", faces, most,
                          length_ > 0 ? "ask for longer edges" : "ask for fewer"));
}

double Target::face_side(double area) const {
  return edge_length(area) / sides_;
}

bool splits_only_once(const RemeshOptions& options) {
  return options.graph.nodes == GraphNodes::faces || !options.guides.empty();
}

bool has_given_positions(const RemeshOptions& options) {
  return options.fields != nullptr && !options.fields->position.points.empty();
}

double Target::longest_edge() const {
  // The paper's half of an edge (section 3.8) gives the same faces in twice the time; measured. The
  // coarse lattice of pure quads needs more vertices for a cell.
  return kind_ == OutputFaces::quads ? 0.525 : 0.75;
}

double Target::longest_input_edge(const RemeshOptions& options, double area,
                                  double mean_edge) const {
  const double longest = longest_edge() * edge_length(area);
  const double smallest = splits_only_once(options) ? smallest_share(options) : 1;
  return std::min(smallest * longest, 2 * mean_edge);
}

double Target::sparsest_points(const RemeshOptions& options, double area) const {
  return longest_edge() * edge_length(area) * smallest_share(options);
}

CoarseEdges Target::coarse_edges(const RemeshOptions& options, double area) const {
  // As few vertices as leave the fields as they were; measured. Nor must the surface of pure quads
  // be coarser than they are.
  constexpr double shortest = 0.44;  // of the longest
  const double longest = longest_edge() * edge_length(area) * smallest_share(options);
  return {static_cast<float>(shortest * longest), static_cast<float>(longest)};
}

CloudDensity Target::density_of_cloud(const RemeshOptions& options) const {
  // What is nearer to each other than neighbours are counts as one side of a thin part.
  constexpr double cell = 0.36;   // of the longest edge
  constexpr double planes = 1.5;  // cells of a plane, by how many squares as wide cover it
  const double longest = cell * longest_edge() * smallest_share(options);
  if (cells_ > 0) return {.points = planes * cells_ * cell_area_ / (longest * longest)};
  return {.cell = longest * length_};
}

bool Target::may_be_dense(const RemeshOptions& options, std::size_t vertices) const {
  constexpr std::size_t many = 8000;                      // for something to be gained
  return options.coarsen && options.fields == nullptr &&  // of which all are wanted
         options.graph.nodes == GraphNodes::vertices && vertices >= many;
}

bool Target::is_dense(const RemeshOptions& options, std::size_t vertices,
                      const SurfaceSize& size) const {
  constexpr double enough = 0.9;  // of the shortest edges
  return may_be_dense(options, vertices) &&
         size.edges.mean < enough * double{coarse_edges(options, size.area).shortest};
}

double Target::growth(double grading) const {
  // Sides that grow as exp(r n) over n faces in a row grow by r with the distance.
  return sides_ * std::log(grading) / 3;
}

EdgeLength Target::edge_lengths(const Graph& graph, const EdgeLength& relative, double growth,
                                const Context& context) const {
  const auto factor = [&](const EdgeLength& lengths) {
    return cells_ > 0 ? length_for_count(graph, lengths, cell_area_, cells_) : length_;
  };
  if (relative.uniform()) return scaled(relative, factor(relative));
  // What grading takes from the long edges makes for more faces, so that all grow a little.
  constexpr int rounds = 8;
  constexpr double near_enough = 1.002;
  EdgeLength lengths = graded(graph, scaled(relative, factor(relative)), growth, context);
  for (int round = 1; round < rounds && cells_ > 0; ++round) {
    const double missing = factor(lengths);
    if (missing < near_enough) break;
    lengths = graded(graph, scaled(lengths, missing), growth, context);
  }
  return lengths;
}

double Target::count_ratio(const Mesh& mesh) const {
  // A mesh that is still to be split gets a quad for each corner, and a vertex for each edge and
  // face.
  const bool split = kind_ == OutputFaces::quads;
  const std::size_t corners = mesh.faces.corners().size();
  const std::size_t faces = split ? corners : mesh.faces.size();
  if (faces_ > 0) return ratio(faces, 0);
  const std::size_t vertices =
      mesh.positions.size() + (split ? mesh.faces.size() + edges_of(mesh).size() : 0);
  return ratio(faces, vertices);
}

double Target::ratio(std::size_t faces, std::size_t vertices) const {
  if (faces_ > 0) return static_cast<double>(faces) / faces_;
  if (vertices_ > 0) return static_cast<double>(vertices) / vertices_;
  return 1;
}

double Target::surplus() const {
  return cells_ > 0 ? std::max(tolerance(), 1 / std::sqrt(cells_)) : tolerance();
}

std::size_t Target::faces_to_close(const Mesh& mesh, double tolerance) const {
  // Each of them takes away one cell: its faces, and its vertices.
  const double vertices = kind_ == OutputFaces::quads ? 4 : 1;
  const double excess = count_ratio(mesh) - 1 - tolerance;
  return static_cast<std::size_t>(std::max(
      0.0,
      std::ceil(faces_ > 0 ? excess * faces_ / faces_per_cell_ : excess * vertices_ / vertices)));
}

std::size_t Target::missing_quads(const Mesh& mesh) const {
  const double missing = 1 - tolerance() - count_ratio(mesh);
  return static_cast<std::size_t>(
      std::max(0.0, std::ceil(missing * (faces_ > 0 ? faces_ : vertices_))));
}

double Target::finished_ratio(const Mesh& mesh) const {
  return ratio(mesh.faces.size(), mesh.positions.size());
}

std::size_t Target::spare_faces(const Mesh& mesh) const {
  // A vertex goes with each of them.
  const auto count = static_cast<double>(faces_ > 0 ? mesh.faces.size() : mesh.positions.size());
  const double wanted = faces_ > 0 ? faces_ : vertices_ > 0 ? vertices_ : count;
  return static_cast<std::size_t>(std::max(0.0, count - (1 - tolerance()) * wanted));
}

}  // namespace meshgrain
