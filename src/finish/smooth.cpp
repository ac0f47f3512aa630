#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "finish/feature_lines.h"
#include "finish/projector.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/finish.h"
#include "meshgrain/surface.h"

namespace meshgrain {
namespace {

/// For every corner of a face, its place in the regular polygon that fits the face best: the face
/// in its mean plane as complex numbers, of which the first Fourier coefficient is that polygon (in
/// the least-squares sense, with free size and turn). The size is then drawn towards that of a
/// polygon of the given side. A face that has turned over, or nearly, is fitted by a polygon that
/// has not: `upward` is the normal of the surface under it.
void regular_targets(std::span<const Index> face, const std::vector<Vec3>& positions,
                     const Vec3& upward, float side, float evenness, std::span<Vec3> targets) {
  const std::size_t n = face.size();
  Vec3 center = Vec3::Zero(), normal = Vec3::Zero();
  for (const Index v : face) center += positions[v];
  center /= static_cast<float>(n);
  for (std::size_t k = 0; k < n; ++k) {
    normal += (positions[face[k]] - center).cross(positions[face[(k + 1) % n]] - center);
  }
  if (normal.dot(upward) < 0.2f * normal.norm()) normal = upward;
  const float length = normal.norm();
  if (!(length > 0)) {
    std::fill(targets.begin(), targets.end(), center);
    return;
  }
  normal /= length;
  Vec3 x = positions[face[0]] - center;
  x -= normal * normal.dot(x);
  if (!(x.norm() > 0)) x = normal.unitOrthogonal();
  x.normalize();
  const Vec3 y = normal.cross(x);
  const float step = 2 * std::numbers::pi_v<float> / static_cast<float>(n);
  std::complex<float> coefficient = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 d = positions[face[k]] - center;
    coefficient +=
        std::complex<float>(d.dot(x), d.dot(y)) * std::polar(1.0f, -step * static_cast<float>(k));
  }
  coefficient /= static_cast<float>(n);
  const float radius = side / (2 * std::sin(step / 2));
  if (const float size = std::abs(coefficient); size > 0) {
    coefficient *= 1 - evenness + evenness * radius / size;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const auto z = coefficient * std::polar(1.0f, step * static_cast<float>(k));
    targets[k] = center + z.real() * x + z.imag() * y;
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

}  // namespace

void smooth(Extraction& extraction, const Mesh& surface, const Graph& graph,
            const SmoothOptions& options, const Context& context) {
  constexpr std::size_t grain = 1024;
  // Each step goes on in part where the last one went (Polyak's heavy ball): faults that reach far
  // then fade in as many iterations as they are edges wide, rather than in the square of that.
  constexpr float momentum = 0.9f;
  std::vector<Vec3> previous;
  const auto evenness = static_cast<float>(options.evenness);
  Mesh& mesh = extraction.mesh;
  std::vector<Index>& seeds = extraction.nodes;
  const Projector projector(surface, graph, context);
  const FeatureLines lines(surface, options.crease_degrees, context);
  Rails rails = attach_to_lines(extraction, surface, lines);
  const VertexFaces around = vertex_faces(mesh, context);

  const auto place = [&](const Vec3& p, std::size_t v) -> Vec3 {
    if (rails.seed[v] != no_index) {
      return rails.fixed[v] ? surface.positions[rails.seed[v]] : lines.project(p, rails.seed[v]);
    }
    return rails.fixed[v] ? mesh.positions[v] : projector.project(p, seeds[v]);
  };

  std::vector<Vec3> targets(mesh.faces.corners().size());
  std::vector<Vec3> next(mesh.positions.size());
  std::vector<Vec3> normals(mesh.positions.size());  // of the surface
  const std::size_t n = mesh.positions.size();
  for (int iteration = 0; iteration <= options.iterations; ++iteration) {
    context.progress("smoothing", (iteration + 0.5) / (options.iterations + 1.0));
    if (iteration == 0) {
      // First of all onto the surface.
      context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) next[v] = place(mesh.positions[v], v);
      });
      mesh.positions.swap(next);
      continue;
    }
    if (iteration % 4 == 1) {  // vertices move over the surface slowly
      context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) normals[v] = projector.normal(seeds[v]);
      });
    }
    const float side = mean_side(mesh, options.relative_size);
    context.for_ranges(mesh.faces.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        float relative = 0;
        Vec3 upward = Vec3::Zero();
        for (const Index v : std::as_const(mesh.faces)[f]) {
          relative += options.relative_size[v];
          upward += normals[v];
        }
        relative /= static_cast<float>(mesh.faces.degree(f));
        const float length = upward.norm();
        if (length > 0) upward /= length;
        regular_targets(std::as_const(mesh.faces)[f], mesh.positions, upward, relative * side,
                        evenness, {targets.data() + mesh.faces.first(f), mesh.faces.degree(f)});
      }
    });
    context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        Vec3 sum = Vec3::Zero();
        for (const Index f : around[v]) {
          const auto face = std::as_const(mesh.faces)[f];
          for (std::size_t k = 0; k < face.size(); ++k) {
            if (face[k] == v) sum += targets[mesh.faces.first(f) + k];
          }
        }
        const auto count = static_cast<float>(around[v].size());
        const Vec3& p = mesh.positions[v];
        Vec3 step = count > 0 ? Vec3(sum / count - p) : Vec3(Vec3::Zero());
        if (iteration > 2) step += momentum * (p - previous[v]);
        next[v] = place(p + step, v);
      }
    });
    previous = mesh.positions;
    mesh.positions.swap(next);
  }
}

}  // namespace meshgrain
