#include "meshgrain/remesh.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "field/transfer.h"
#include "mesh/border.h"
#include "mesh/frame.h"
#include "meshgrain/clean.h"
#include "meshgrain/error.h"
#include "meshgrain/extract.h"
#include "meshgrain/finish.h"
#include "meshgrain/hierarchy.h"
#include "meshgrain/singularities.h"
#include "meshgrain/surface.h"
#include "meshgrain/triangulate.h"

namespace meshgrain {
namespace {

/// Runs the stages one after the other, each under its name and with its time taken.
class Stages {
 public:
  Stages(const Context& context, RemeshReport& report) : context_(context), report_(report) {}

  template <typename Body>
  auto operator()(const char* name, const Body& body) {
    context_.progress(name, 0);
    const auto start = std::chrono::steady_clock::now();
    const auto record = [&] {
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
      report_.stages.push_back({name, time.count()});
      context_.progress(name, 1);
    };
    if constexpr (std::is_void_v<decltype(body())>) {
      body();
      record();
    } else {
      auto result = body();
      record();
      return result;
    }
  }

 private:
  const Context& context_;
  RemeshReport& report_;
};

int posy_of(OutputFaces faces) {
  return faces == OutputFaces::triangles || faces == OutputFaces::hexagons ? 6 : 4;
}

void check(const RemeshOptions& options) {
  const int posy = posy_of(options.faces);
  if (options.rosy != 0 && posy % options.rosy != 0) {
    throw Error("orientations of symmetry " + std::to_string(options.rosy) +
                " do not fit positions of symmetry " + std::to_string(posy) +
                ": use 1, 2 or 4 for quads, 1, 2 or 6 for triangles");
  }
  if (options.edge_length < 0 || !std::isfinite(options.edge_length)) {
    throw Error("the target edge length must be a positive number");
  }
  if (options.smoothing < 0) throw Error("the number of smoothing iterations must not be negative");
  if (options.solver.sweeps < 1) throw Error("at least one sweep a level is needed");
}

void describe(const CleanReport& cleaned, std::vector<std::string>& notes) {
  const auto note = [&](std::size_t count, const char* what) {
    if (count > 0) notes.push_back("removed " + std::to_string(count) + " " + what);
  };
  note(cleaned.repeated_corners, "repeated corners of faces");
  note(cleaned.degenerate_faces, "degenerate faces");
  note(cleaned.duplicate_faces, "duplicate faces");
  note(cleaned.unused_vertices, "vertices that no face uses");
  note(cleaned.duplicate_points, "duplicate points");
}

/// How the counts of the written mesh relate to the lattice that the position field makes.
struct Target {
  double cells = 0;         ///< Wanted lattice cells (squares, or pairs of triangles); 0 if by length.
  double length = 0;        ///< Wanted lattice edge length, if `cells` is 0.
  double cell_area = 1;     ///< Of a lattice cell, in squared edge lengths.
};

Target lattice_target(const RemeshOptions& options, std::size_t input_vertices) {
  Target target;
  // A 6-PoSy cell is two triangles, or one vertex; of its dual, two vertices or one hexagon.
  const bool triangular = posy_of(options.faces) == 6;
  if (triangular) target.cell_area = std::sqrt(3.0) / 2;
  // A pure quad mesh has four quads, and four vertices, for each of the lattice's before its split.
  const bool split = options.faces == OutputFaces::quads;
  const double faces_per_cell = split ? 4 : options.faces == OutputFaces::triangles ? 2 : 1;
  const double vertices_per_cell = split ? 4 : options.faces == OutputFaces::hexagons ? 2 : 1;
  if (options.edge_length > 0) {
    target.length = options.edge_length * (split ? 2 : 1);
    // The edges of the dual are as long as the triangles' radii of the inscribed circle, twice.
    if (options.faces == OutputFaces::hexagons) target.length *= std::sqrt(3.0);
  } else if (options.face_count > 0) {
    target.cells = static_cast<double>(options.face_count) / faces_per_cell;
  } else {
    const double vertices = options.vertex_count > 0
                                ? static_cast<double>(options.vertex_count)
                                : std::max(1.0, static_cast<double>(input_vertices) / 16);
    target.cells = vertices / vertices_per_cell;
  }
  return target;
}

/// Pairs of neighbouring nodes that lie on the border of the surface.
std::vector<std::array<Index, 2>> border_of_graph(const Mesh& surface, const Graph& graph,
                                                  GraphNodes nodes) {
  if (surface.is_point_cloud() || nodes == GraphNodes::vertices) return border_edges(surface);
  std::vector<std::uint8_t> on_border(surface.positions.size(), 0);
  for (const auto& [a, b] : border_edges(surface)) on_border[a] = on_border[b] = 1;
  const auto touches = [&](Index f) {
    const auto face = surface.faces[f];
    return on_border[face[0]] || on_border[face[1]] || on_border[face[2]];
  };
  std::vector<std::array<Index, 2>> result;
  for (Index f = 0; f < graph.size(); ++f) {
    for (const Index g : graph.neighbors_of(f)) {
      if (f < g && touches(f) && touches(g)) result.push_back({f, g});
    }
  }
  return result;
}

/// How many faces or vertices were got for one that was asked for; 1 if no count was asked for.
double count_ratio(const RemeshOptions& options, std::size_t input_vertices, const Mesh& mesh) {
  if (options.edge_length > 0) return 1;
  if (options.face_count > 0) {
    return static_cast<double>(mesh.faces.size()) / static_cast<double>(options.face_count);
  }
  const double wanted = options.vertex_count > 0 ? static_cast<double>(options.vertex_count)
                                                 : static_cast<double>(input_vertices) / 16;
  return static_cast<double>(mesh.positions.size()) / std::max(wanted, 1.0);
}

}  // namespace

RemeshResult remesh(Mesh input, const RemeshOptions& options, const Context& context) {
  check(options);
  RemeshResult result;
  RemeshReport& report = result.report;
  Stages stage(context, report);
  report.input_vertices = input.positions.size();
  report.input_faces = input.faces.size();
  const int posy = posy_of(options.faces);
  const bool cloud = input.is_point_cloud();

  // The surface: clean, of triangles, about one unit large, fine enough for the target, in the order
  // of a curve.
  Frame frame;
  Mesh surface = stage("clean", [&] {
    describe(clean(input), report.notes);
    frame = unit_frame(input);
    enter(frame, input);
    return cloud ? std::move(input) : triangulate(input);
  });
  input = Mesh();
  Target target = lattice_target(options, report.input_vertices);
  target.length /= frame.scale;
  if (!cloud) {
    stage("subdivide", [&] {
      const double area = surface_area(surface);
      if (!(area > 0)) throw Error("the input has no surface: all of its faces are degenerate");
      const double length =
          target.cells > 0 ? std::sqrt(area / (target.cells * target.cell_area)) : target.length;
      // Where faces vary in size, fine enough for the smallest of them.
      const double smallest =
          options.sizing.kind == Sizing::Kind::uniform ? 1.0 : 1.0 / options.sizing.ratio;
      const EdgeLengths edges = edge_lengths(surface);
      const double limit = std::min(length * smallest / 2, 2 * edges.mean);
      if (edges.max > limit) subdivide(surface, limit, context);
    });
  }
  stage("order", [&] { sort_along_curve(surface, context); });

  Hierarchy hierarchy;
  {
    Graph graph = stage("graph", [&] { return build_graph(surface, options.graph, context); });
    report.nodes = graph.size();
    report.edges = graph.neighbors.size() / 2;
    hierarchy = stage("hierarchy", [&] { return build_hierarchy(std::move(graph), context); });
    report.levels = hierarchy.levels.size();
  }
  const Graph& graph = hierarchy.levels[0];

  Sizing sizing = options.sizing;
  sizing.point = frame.inside(sizing.point);
  double mean_area = 0;
  for (const float area : graph.areas) mean_area += area;
  const double mean_length = target.cells > 0
                                 ? std::sqrt(mean_area / (target.cells * target.cell_area))
                                 : target.length;
  const EdgeLength relative =
      relative_edge_lengths(graph, sizing, surface.values, mean_length, context);
  EdgeLength lengths = scaled(
      relative, target.cells > 0
                    ? length_for_count(graph, relative, target.cell_area, target.cells)
                    : target.length);

  BorderConstraints border;
  if (options.align_border && !cloud && options.graph.nodes == GraphNodes::vertices) {
    border = border_constraints(surface);
  }

  // The orientation field.
  Fields& fields = result.fields;
  stage("orientation field", [&] {
    OrientationOptions orientation;
    static_cast<SolverOptions&>(orientation) = options.solver;
    orientation.rosy = options.rosy != 0 ? options.rosy : posy;
    orientation.energy = options.orientation_energy;
    if (options.fields != nullptr) {
      fields.orientation = transfer_orientation(*options.fields, graph, frame, context);
      return;
    }
    auto constraints = curvature_constraints(graph, static_cast<float>(mean_length),
                                             options.curvature, context);
    constraints.insert(constraints.end(), border.orientation.begin(), border.orientation.end());
    const auto solver = OrientationSolver::create(hierarchy, orientation, constraints);
    while (solver->step(context)) context.progress("orientation field", solver->progress());
    fields.orientation = solver->field();
    report.orientation_energies = solver->energies();
  });

  // Positions and the mesh; where a count was asked for and missed, again with edges that much longer
  // or shorter, and the nearest is kept.
  ExtractOptions extract;
  extract.energy = options.position_energy;
  if (!cloud && options.graph.nodes == GraphNodes::vertices) {
    extract.surface = &surface;
    extract.manifold = options.manifold;
  } else {
    extract.border = border_of_graph(surface, graph, options.graph.nodes);
  }
  if (cloud) extract.largest_filled_gap = 12;
  Extraction extraction;
  const bool given = options.fields != nullptr && !options.fields->position.points.empty();
  double least_error = std::numeric_limits<double>::infinity();
  for (int attempt = 0; attempt < 3; ++attempt) {
    PositionField field = stage("position field", [&] {
      if (given) return transfer_position(*options.fields, graph, frame, context);
      PositionOptions position;
      static_cast<SolverOptions&>(position) = options.solver;
      position.posy = posy;
      position.energy = options.position_energy;
      const auto solver = PositionSolver::create(hierarchy, fields.orientation, lengths, position,
                                                 border.position);
      while (solver->step(context)) context.progress("position field", solver->progress());
      report.position_energies = solver->energies();
      return solver->field();
    });
    Extraction found = stage("extraction", [&] {
      Extraction mesh = extract_mesh(graph, fields.orientation, field, extract, context);
      if (options.graph.nodes == GraphNodes::faces && !cloud) {
        for (Index& node : mesh.nodes) node = surface.faces[node][0];
      }
      if (options.manifold) make_manifold(mesh);
      if (options.faces == OutputFaces::quads) split_into_quads(mesh);
      if (options.faces == OutputFaces::hexagons) take_dual(mesh);
      return mesh;
    });
    const double ratio = count_ratio(options, report.input_vertices, found.mesh);
    const double error = std::fabs(std::log(ratio));
    if (error < least_error) {
      least_error = error;
      extraction = std::move(found);
      fields.position = std::move(field);
    }
    constexpr double tolerance = 0.03;
    if (given || error < tolerance) break;
    lengths = scaled(lengths, std::clamp(std::sqrt(ratio), 0.5, 2.0));
  }
  if (extraction.mesh.faces.empty()) {
    throw Error("nothing is left of the surface at this target: ask for more faces, or shorter edges");
  }
  report.edge_length = fields.position.edge_length[0] * frame.scale;

  if (!cloud && options.graph.nodes == GraphNodes::vertices) {
    stage("singularities", [&] {
      report.orientation_singularities =
          orientation_singularities(surface, graph.normals, fields.orientation, context).size();
      report.position_singularities =
          position_singularities(surface, graph, fields.orientation, fields.position,
                                 options.position_energy, context)
              .size();
    });
  }
  stage("smoothing", [&] {
    SmoothOptions smoothing;
    smoothing.iterations = options.smoothing;
    if (!fields.position.edge_length.uniform() && options.graph.nodes == GraphNodes::vertices) {
      std::vector<float> sizes;
      for (const Index node : extraction.nodes) sizes.push_back(fields.position.edge_length[node]);
      smoothing.relative_size = EdgeLength(std::move(sizes));
    }
    smooth(extraction, surface, graph, smoothing, context);
  });

  if (options.graph.nodes == GraphNodes::faces && !cloud) {  // the nodes are a cloud of their own
    surface = Mesh();
    surface.positions = graph.positions;
  }
  fields.surface = std::move(surface);
  fields.surface.normals = graph.normals;
  leave(frame, fields);
  result.mesh = std::move(extraction.mesh);
  leave(frame, result.mesh);
  return result;
}

}  // namespace meshgrain
