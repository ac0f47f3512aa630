#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "finish/bare_ends.h"
#include "finish/lift.h"
#include "finish/local_search.h"
#include "finish/mend_places.h"
#include "finish/placement.h"
#include "finish/untangle.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/finish.h"
#include "meshgrain/surface.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 1024;

/// The regular polygon with n corners at a distance of 1 from zero: the directions of the corners,
/// the first along x, and the length of the sides.
struct RegularPolygon {
  std::vector<std::array<float, 2>> corners;
  float side = 0;

  static RegularPolygon of(std::size_t n) {
    const double step = 2 * std::numbers::pi / static_cast<double>(n);
    RegularPolygon result{{}, static_cast<float>(2 * std::sin(step / 2))};
    for (std::size_t k = 0; k < n; ++k) {
      const double angle = step * static_cast<double>(k);
      result.corners.push_back(
          {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))});
    }
    return result;
  }
};

/// For every corner of a face, its place in the regular polygon that fits the face best: the face
/// in its mean plane as complex numbers, of which the first Fourier coefficient is that polygon (in
/// the least-squares sense, with free size and turn). The size is then drawn towards that of a
/// polygon of the given side. A face that has turned over, or nearly, is fitted by a polygon that
/// has not: `upward` is along the normal of the surface under it.
void regular_targets(std::span<const Index> face, const std::vector<Vec3>& positions,
                     const Vec3& upward, float side, float evenness, std::span<Vec3> targets) {
  static const std::array known{RegularPolygon::of(3), RegularPolygon::of(4),
                                RegularPolygon::of(5), RegularPolygon::of(6),
                                RegularPolygon::of(7), RegularPolygon::of(8)};
  const std::size_t n = face.size();
  const bool is_known = n - 3 < known.size();
  RegularPolygon larger;
  if (!is_known) larger = RegularPolygon::of(n);
  const RegularPolygon& polygon = is_known ? known[n - 3] : larger;
  // The coefficient is the mean of the corners, each turned back by the angle of the polygon's.
  Vec3 center = Vec3::Zero(), along = Vec3::Zero(), across = Vec3::Zero(), normal = Vec3::Zero();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3& p = positions[face[k]];
    center += p;
    along += polygon.corners[k][0] * p;
    across += polygon.corners[k][1] * p;
  }
  const Vec3& first = positions[face[0]];
  for (std::size_t k = 2; k < n; ++k) {
    normal += (positions[face[k - 1]] - first).cross(positions[face[k]] - first);
  }
  const auto count = static_cast<float>(n);
  center /= count;
  float squared_length = normal.squaredNorm();
  const float upright = normal.dot(upward);
  if (upright <= 0 || upright * upright < 0.04f * squared_length * upward.squaredNorm()) {
    normal = upward;
    squared_length = upward.squaredNorm();
  }
  if (!(squared_length > 0)) {
    std::fill(targets.begin(), targets.end(), center);
    return;
  }
  normal /= std::sqrt(squared_length);
  Vec3 x = (along - normal.cross(across)) / count;
  x -= normal * normal.dot(x);
  if (const float size = x.norm(); size > 0) {
    x *= 1 - evenness + evenness * side / (polygon.side * size);
  }
  const Vec3 y = normal.cross(x);
  for (std::size_t k = 0; k < n; ++k) {
    targets[k] = center + polygon.corners[k][0] * x + polygon.corners[k][1] * y;
  }
}

/// The side that all faces would have if their areas were as even as their relative sizes ask for.
float mean_side(const Mesh& mesh, const EdgeLength& relative) {
  double area = 0, wanted = 0;  // of the faces; of the regular polygons of side 1 in their places
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    const auto n = static_cast<double>(face.size());
    const Vec3& a = mesh.positions[face[0]];
    Vec3 cross = Vec3::Zero();
    double size = 0;
    for (std::size_t k = 0; k < face.size(); ++k) {
      size += relative[face[k]] / n;
      if (k >= 2) {
        cross += (mesh.positions[face[k - 1]] - a).cross(mesh.positions[face[k]] - a);
      }
    }
    area += cross.norm() / 2;
    wanted += size * size * n / (4 * std::tan(std::numbers::pi / n));
  }
  return wanted > 0 ? static_cast<float>(std::sqrt(area / wanted)) : 0.0f;
}

/// Each iteration fits a regular polygon to every face, moves each vertex to the mean of its places
/// in those, and back onto the surface.
class Smoother {
 public:
  /// Puts all vertices onto the surface.
  Smoother(Extraction& extraction, const Mesh& surface, const Graph& graph,
           const FeatureLines& features, const SmoothOptions& options, const Context& context);

  void iterate(int iterations);

  /// Pulls the mesh out to the ends of fingers and horns, and holds it there.
  void hold_ends();

  /// Mends single faces that are turned over, nearly degenerate, or pass through others.
  void mend();

  /// Off the surface, so that the faces lie on both sides of it.
  void lift();

 private:
  template <typename Body>
  void for_vertices(const Body& body) const;
  void look_up_sizes();
  void fit_polygons(float side);
  Vec3 mean_target(Index v) const;

  Extraction& extraction_;
  Mesh& mesh_;
  const Graph& graph_;
  bool nodes_are_vertices_;
  const SmoothOptions& options_;
  const Context& context_;
  Placement placement_;
  VertexFaces around_;
  std::vector<Index> corners_;  // beside around_.faces: which corner of the face the vertex is
  EdgeLength sizes_{1.0f};      // relative, of the vertices where they are
  std::vector<Vec3> previous_;  // positions, one iteration ago
  std::vector<Vec3> targets_;   // of every corner of a face
  std::vector<Vec3> normals_;   // of the surface
};

Smoother::Smoother(Extraction& extraction, const Mesh& surface, const Graph& graph,
                   const FeatureLines& features, const SmoothOptions& options,
                   const Context& context)
    : extraction_(extraction),
      mesh_(extraction.mesh),
      graph_(graph),
      nodes_are_vertices_(graph.size() == surface.positions.size()),
      options_(options),
      context_(context),
      placement_(extraction, surface, graph, features, context),
      around_(vertex_faces(mesh_, context)),
      corners_(around_.faces.size()) {
  for_vertices([&](std::size_t v) {
    for (Index k = around_.offsets[v]; k < around_.offsets[v + 1]; ++k) {
      const auto face = std::as_const(mesh_.faces)[around_.faces[k]];
      const auto corner = std::find(face.begin(), face.end(), v) - face.begin();
      corners_[k] = static_cast<Index>(mesh_.faces.first(around_.faces[k]) +
                                       static_cast<std::size_t>(corner));
    }
  });
  previous_.resize(mesh_.positions.size());
  for_vertices([&](std::size_t v) { previous_[v] = placement_.place(mesh_.positions[v], v); });
  mesh_.positions = previous_;
  placement_.go_around(around_);
  previous_ = mesh_.positions;
}

template <typename Body>
void Smoother::for_vertices(const Body& body) const {
  context_.for_ranges(mesh_.positions.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) body(v);
  });
}

void Smoother::look_up_sizes() {
  if (options_.relative_size.uniform()) return;
  sizes_.values.resize(mesh_.positions.size());
  for_vertices(
      [&](std::size_t v) { sizes_.values[v] = options_.relative_size[extraction_.nodes[v]]; });
}

void Smoother::fit_polygons(float side) {
  targets_.resize(mesh_.faces.corners().size());
  const auto evenness = static_cast<float>(options_.evenness);
  context_.for_ranges(mesh_.faces.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto face = std::as_const(mesh_.faces)[f];
      float relative = 0;
      Vec3 upward = Vec3::Zero();
      for (const Index v : face) {
        relative += sizes_[v];
        upward += normals_[v];
      }
      relative /= static_cast<float>(face.size());
      regular_targets(face, mesh_.positions, upward, relative * side, evenness,
                      {targets_.data() + mesh_.faces.first(f), face.size()});
    }
  });
}

Vec3 Smoother::mean_target(Index v) const {
  Vec3 sum = Vec3::Zero();
  for (Index k = around_.offsets[v]; k < around_.offsets[v + 1]; ++k) sum += targets_[corners_[k]];
  return sum / static_cast<float>(around_[v].size());
}

void Smoother::iterate(int iterations) {
  // Each step goes on in part where the last one went (Polyak's heavy ball): faults that reach far
  // then fade in as many iterations as they are edges wide, rather than in the square of that.
  constexpr float momentum = 0.9f;
  // Vertices move over the surface slowly: a plane that touches it near them serves for some steps.
  constexpr int steps_on_plane = 4;
  const std::size_t count = mesh_.positions.size();
  std::vector<Vec3> next(count);
  std::vector<Projector::Plane> planes(count);
  normals_.resize(count);
  for_vertices([&](std::size_t v) { normals_[v] = placement_.normal(v); });
  float side = 0;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    context_.progress("smoothing", static_cast<double>(iteration) / iterations);
    const bool look = iteration % steps_on_plane == 0, last = iteration + 1 == iterations;
    if (look) {
      look_up_sizes();
      side = mean_side(mesh_, sizes_);
    }
    fit_polygons(side);
    placement_.note_ways(context_);
    for_vertices([&](std::size_t v) {
      const Vec3& p = mesh_.positions[v];
      Vec3 q = p + momentum * (p - previous_[v]);
      if (!around_[v].empty()) q += mean_target(static_cast<Index>(v)) - p;
      if (last || !placement_.is_free(v)) {
        next[v] = placement_.slide(q, v);
        if (look) normals_[v] = placement_.normal(v);
        return;
      }
      if (look) {
        planes[v] = placement_.touch(q, v);
        normals_[v] = planes[v].normal;
      }
      next[v] = planes[v].project(q);
    });
    previous_.swap(mesh_.positions);
    mesh_.positions.swap(next);
  }
}

void Smoother::hold_ends() {
  if (!nodes_are_vertices_ || options_.is_part) return;
  constexpr float share = 0.9f;
  const float side = mean_side(mesh_, sizes_);
  EdgeLength reach = options_.relative_size;
  for (float& length : reach.values) length *= share * side;
  for (const Reach& end : find_bare_ends(extraction_, around_, graph_, reach, context_)) {
    if (!placement_.is_free(end.vertex) && !placement_.is_tethered(end.vertex)) continue;
    placement_.tether(end.vertex, end.position, end.node, end.tip, end.radius);
    previous_[end.vertex] = end.position;
  }
}

void Smoother::mend() {
  placement_.fit_lines();
  LocalSearch search(extraction_, around_, placement_);
  untangle(mesh_, around_, search, context_);
  mend_places(mesh_, around_, placement_, search, options_, context_);
}

void Smoother::lift() {
  if (options_.lift > 0) lift_vertices(extraction_, around_, placement_, options_.lift, context_);
}

}  // namespace

void smooth(Extraction& extraction, const Mesh& surface, const Graph& graph,
            const SmoothOptions& options, const Context& context) {
  FeatureLines border;
  if (options.features == nullptr && !surface.is_point_cloud()) {
    border = find_features(surface, {.creases = Creases::none, .align_border = false}, 0, context);
  }
  const FeatureLines& features = options.features != nullptr ? *options.features : border;
  Smoother smoother(extraction, surface, graph, features, options, context);
  if (options.iterations == 0) return;
  // Even sizes draw the surface's ends in first of all, so that they show early.
  constexpr int parts = 3;
  for (int part = 0; part < parts; ++part) {
    if (part > 0) smoother.hold_ends();
    smoother.iterate(options.iterations * (part + 1) / parts - options.iterations * part / parts);
  }
  smoother.mend();
  smoother.lift();
}

}  // namespace meshgrain
