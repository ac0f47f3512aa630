#include "symmetry/remesh_symmetric.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "measure/face_shape.h"
#include "mesh/border.h"
#include "meshgrain/error.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "meshgrain/triangulate.h"
#include "remesh/clean_input.h"
#include "remesh/notes.h"
#include "remesh/sharpen_part.h"
#include "remesh/target.h"
#include "symmetry/border_in_planes.h"
#include "symmetry/fold_guides.h"
#include "symmetry/plane_search.h"

namespace meshgrain {
namespace {

/// The planes about which the input is symmetric, of those that are asked for.
std::vector<MirrorPlane> find_symmetry(const Mesh& input, const Symmetry& symmetry,
                                       std::vector<std::string>& notes, const Context& context) {
  constexpr double tolerance = 0.01;  // of the diagonal, for the mean distance to the mirror image
  constexpr double most_unlike = 0.001;  // so small a fin is hardly to be seen
  const PlaneSearch search(input, context);
  std::vector<MirrorPlane> planes;
  for (int axis = 0; axis < 3; ++axis) {
    if (!symmetry.automatic && !symmetry.axes[axis]) continue;
    const MirrorPlane plane = search.find(axis, context);
    if (count_faces_in(input, plane) == input.faces.size()) continue;  // its own mirror image
    const bool is_like = plane.mismatch <= tolerance;
    const bool is_whole = plane.unlike <= most_unlike;
    // Whoever asks for a plane may well want one of two halves that differ.
    if (is_like && (is_whole || !symmetry.automatic)) planes.push_back(plane);
    if (symmetry.automatic) continue;
    if (!is_like) {
      notes.push_back(fmt::format("not symmetric across {}", "xyz"[axis]));
    } else if (!is_whole) {
      notes.push_back(fmt::format(
          "{:.1f} % of the input has nothing like it across {}, and is lost or on both sides now",
          100 * plane.unlike, "xyz"[axis]));
    }
  }
  if (!symmetry.automatic) return planes;
  const auto less = [](const MirrorPlane& a, const MirrorPlane& b) {
    return a.mismatch < b.mismatch;
  };
  // One is enough: every plane is one more line that edges must follow.
  const auto best = std::min_element(planes.begin(), planes.end(), less);
  if (best != planes.end()) return {*best};
  notes.emplace_back("not symmetric across x, y or z");
  return {};
}

/// Of the border, in the plane through the origin across an axis.
double length_in_plane(const Mesh& mesh, int axis, const Context& context) {
  double sum = 0;
  for (const auto& [a, b] : border_edges(mesh, context)) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b];
    if (p[axis] == 0 && q[axis] == 0) sum += (q - p).norm();
  }
  return sum;
}

/// What a manifold would have twice, were both halves of it like one; of others nothing.
struct Topology {
  std::size_t components = 0, boundary_loops = 0;
  long euler = 0;
  bool operator==(const Topology&) const = default;
};

Topology topology(const Mesh& mesh) {
  const MeshStatistics s = mesh_statistics(mesh);
  if (s.non_manifold_edges + s.non_manifold_vertices > 0) return {};
  return {s.components, s.boundary_loops, s.euler};
}

/// Cuts a mesh at planes, so that one part of it is left, and lets the options be those for this
/// part. `side`: of the faces to be.
void cut_to_part(Mesh& mesh, RemeshOptions& options, const std::vector<MirrorPlane>& planes,
                 double side, std::vector<std::string>& notes, const Context& context) {
  for (const MirrorPlane& plane : planes) {
    if (const std::size_t count = count_faces_in(mesh, plane); count > 0) {
      notes.push_back("left out " + std::to_string(count) + " faces in the mirror plane across " +
                      "xyz"[plane.axis]);
    }
    cut_at(mesh, plane);
    // Positions now count from the plane, and are in the units of the input from its origin.
    options.guides = fold_guides(options.guides, {plane.axis, mesh.origin[plane.axis], 0});
    options.face_count = (options.face_count + 1) / 2;
    if (options.vertex_count > 0) {
      const double in_both = length_in_plane(mesh, plane.axis, context) / side;
      options.vertex_count =
          (options.vertex_count + static_cast<std::size_t>(std::lround(in_both)) + 1) / 2;
    }
    // A point beyond the plane has its mirror image on this side.
    double& coordinate = options.sizing.point[plane.axis];
    const double middle = mesh.origin[plane.axis];
    coordinate = middle + std::abs(coordinate - middle);
  }
}

/// One part of a mesh that was cut at planes, remeshed, and with all of its mirror images.
RemeshedHalf remesh_part(Mesh part, const RemeshOptions& options,
                         const std::vector<MirrorPlane>& planes, const RemeshHalf& remesh_half,
                         const Context& context) {
  const bool is_closed = !planes.empty() && has_border_in_planes_only(part, planes, context);
  RemeshedHalf made = remesh_half(std::move(part), options, context);
  Mesh& mesh = made.result.mesh;
  if (is_closed) put_border_into_planes(mesh, planes, context);
  const double near =
      is_closed ? std::numeric_limits<double>::min() : 0.2 * edge_lengths(mesh, context).mean;
  for (const MirrorPlane& plane : planes) {
    add_mirror_image(mesh, plane.axis, near);
    made.faults = {2 * made.faults.inverted, 2 * made.faults.crossings};
  }
  return made;
}

/// Whether such a part with its mirror images is what the mesh was.
bool is_part_of(Mesh part, const std::vector<MirrorPlane>& planes, const Topology& whole) {
  for (const MirrorPlane& plane : planes) {
    add_mirror_image(part, plane.axis, std::numeric_limits<double>::min());
  }
  return topology(part) == whole;
}

/// Of few faces a part may have none that keeps its border in each of the planes: makes up to eight
/// times as many in place of those of `made`. Returns whether they hang together as the whole did.
bool make_finer(RemeshedHalf& made, const Mesh& part, RemeshOptions options,
                const std::vector<MirrorPlane>& planes, const Topology& whole,
                const RemeshHalf& remesh_half, const Context& context) {
  constexpr int attempts = 3;
  for (int k = 0; k < attempts; ++k) {
    options.edge_length /= std::numbers::sqrt2;
    options.face_count *= 2;
    options.vertex_count *= 2;
    RemeshedHalf other = remesh_part(part, options, planes, remesh_half, context);
    if (topology(other.result.mesh) != whole) continue;
    made = std::move(other);
    return true;
  }
  return false;
}

}  // namespace

RemeshResult remesh_symmetric(Mesh input, RemeshOptions options, const RemeshHalf& remesh_half,
                              const Context& context) {
  if (input.is_point_cloud()) throw Error("symmetry needs a mesh: the input is a point cloud");
  if (options.faces == OutputFaces::hexagons) throw Error("hexagons cannot be made symmetric");
  const std::size_t vertices = input.positions.size(), faces = input.faces.size();
  std::vector<std::string> notes = clean_input(input, context);
  auto border = border_edges(input, context);
  for (auto& note : contract_border_of(input, border, context)) notes.push_back(std::move(note));
  if (!(surface_area(input, context) > 0)) {
    throw Error("the input has no surface: all of its faces are degenerate");
  }
  const auto planes = find_symmetry(input, options.symmetry, notes, context);
  options.symmetry = {};
  options.memory_limit = 0;  // has been looked at for the whole
  if (options.edge_length == 0 && options.face_count == 0 && options.vertex_count == 0) {
    options.vertex_count = default_vertex_count(input.positions.size(), false);
  }
  Topology before;
  double side = 0;  // of the faces to be
  if (!planes.empty()) {
    before = topology(input);
    input = triangulate(input);
    // Before the cut, whose border has to stay where it is.
    const Target target(options, options.faces, 0, 1);  // the options have a count
    side = target.face_side(surface_area(input, context));
    if (sharpen_part(input, options, side, notes, context)) {
      options.features.creases = Creases::marked;
    }
  }
  cut_to_part(input, options, planes, side, notes, context);
  // Where a half is a single quad wide, its two sides would be in the plane.
  if (!planes.empty()) options.fine_lattice = false;
  const bool has_few_faces = surface_area(input, context) < few_faces * side * side;
  const Mesh part = has_few_faces ? input : Mesh();
  RemeshedHalf made = remesh_part(std::move(input), options, planes, remesh_half, context);
  for (const MirrorPlane& plane : planes) {
    notes.emplace_back("made symmetric across ").push_back("xyz"[plane.axis]);
  }
  if (before.components > 0 && topology(made.result.mesh) != before) {
    const bool may_be_finer = !part.faces.empty() && is_part_of(part, planes, before);
    if (!may_be_finer) {
      notes.emplace_back(
          "the halves of the input are not alike: a hole, handle or piece that only one "
          "has is lost, or on both sides now");
    } else if (!make_finer(made, part, options, planes, before, remesh_half, context)) {
      notes.emplace_back("the result does not hang together as the input does: ask for more faces");
    }
  }
  RemeshResult& result = made.result;
  note_faults(result, made.faults);
  result.report.input_vertices = vertices;
  result.report.input_faces = faces;
  result.report.notes.insert(result.report.notes.end(), notes.begin(), notes.end());
  return std::move(result);
}

}  // namespace meshgrain
