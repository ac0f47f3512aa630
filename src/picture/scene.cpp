#include "picture/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh/edges.h"

namespace meshgrain::picture {
namespace {

/// The eye's axes as rows: right, down, towards the eye.
Eigen::Matrix3f eye_axes(const PictureOptions& options) {
  const Vec3 towards = options.view.normalized();
  Vec3 right = options.up.cross(towards);
  // Looking along `up`, any other direction can be up.
  if (!(right.norm() > 1e-4f * options.up.norm())) right = towards.unitOrthogonal();
  right.normalize();
  Eigen::Matrix3f axes;
  axes << right.transpose(), right.cross(towards).transpose(), towards.transpose();
  return axes;
}

/// Turns the mesh to the eye and scales it to the image, with a margin around it.
void project(const Mesh& mesh, const PictureOptions& options, Scene& scene) {
  const Eigen::Matrix3f axes = eye_axes(options);
  Eigen::AlignedBox3f box;
  const auto cover = [&](Index v) {
    if (mesh.positions[v].allFinite()) box.extend(axes * mesh.positions[v]);
  };
  if (mesh.is_point_cloud())
    for (Index v = 0; v < mesh.positions.size(); ++v) cover(v);
  else
    for (Index v : mesh.faces.corners()) cover(v);
  if (box.isEmpty()) return;

  const Vec3 middle = box.center(), size = box.sizes();
  const float margin = 0.05f * float(std::min(options.width, options.height));
  const float width = std::max(1.0f, float(options.width) - 2 * margin);
  const float height = std::max(1.0f, float(options.height) - 2 * margin);
  // A surface seen edge on, or a single point, is not to be blown up without end.
  const float least = std::max(1e-3f * size.maxCoeff(), 1e-30f);
  const float scale = options.zoom * std::min(width / std::max(size.x(), least),
                                              height / std::max(size.y(), least));
  const Vec3 centre(float(options.width) / 2, float(options.height) / 2, 0);
  scene.points.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) scene.points.push_back(scale * (axes * p - middle) + centre);
  if (mesh.is_point_cloud() && mesh.normals.size() == mesh.positions.size())
    for (const Vec3& n : mesh.normals) scene.normals.push_back(axes * n);
}

/// Normals at the triangles' corners: the mean of those faces around the vertex that are nearly
/// parallel, so that smooth surfaces look smooth and creases stay sharp.
void add_normals(Scene& scene, const Context& context) {
  constexpr float crease_cosine = 0.78f;  // 39 degrees
  const std::size_t count = scene.triangles.size();
  std::vector<Vec3> flat(count);  // as long as twice the area
  std::vector<std::size_t> end(scene.points.size() + 1, 0);
  for (std::size_t t = 0; t < count; ++t) {
    const auto [a, b, c] = scene.triangles[t];
    const auto& p = scene.points;
    flat[t] = (p[c] - p[a]).cross(p[b] - p[a]);  // outwards: the y axis points down
    for (Index v : scene.triangles[t]) ++end[v + 1];
  }
  for (std::size_t v = 1; v < end.size(); ++v) end[v] += end[v - 1];
  std::vector<Index> around(end.back());
  for (std::size_t t = 0; t < count; ++t)
    for (Index v : scene.triangles[t]) around[end[v]++] = static_cast<Index>(t);
  scene.normals.resize(3 * count);
  context.for_ranges(count, 4096, [&](std::size_t from, std::size_t to) {
    for (std::size_t t = from; t < to; ++t)
      for (int k = 0; k < 3; ++k) {
        const Index v = scene.triangles[t][k];
        Vec3 sum = Vec3::Zero();
        for (std::size_t i = v == 0 ? 0 : end[v - 1]; i < end[v]; ++i) {
          const Vec3& n = flat[around[i]];
          if (n.dot(flat[t]) >= crease_cosine * n.norm() * flat[t].norm()) sum += n;
        }
        scene.normals[3 * t + k] = sum.stableNormalized();
      }
  });
}

/// Marks borders and irregular vertices, and chooses the widths of lines and dots.
void add_marks(const Mesh& mesh, const PictureOptions& options, Scene& scene) {
  const std::vector<Edge> edges = edges_of(mesh);
  const VertexDegrees degrees = vertex_degrees(mesh, edges);
  double length = 0;
  for (const Edge& edge : edges) {
    const float l = (scene.points[edge.a] - scene.points[edge.b]).norm();
    if (std::isfinite(l)) length += l;
  }
  const float mean = float(length / double(std::max<std::size_t>(1, edges.size())));
  const float size = float(std::min(options.width, options.height));
  if (options.edges) {
    scene.line_width = std::clamp(0.06f * mean, 0.9f, std::max(1.0f, size / 500));
    scene.line_strength = 0.8f * std::clamp((mean - 2.5f) / 4, 0.0f, 1.0f);
    scene.border_width = std::clamp(0.14f * mean, 1.5f, std::max(2.0f, size / 300));
    scene.border_neighbours.assign(mesh.positions.size(), {no_index, no_index});
    const auto add = [&](Index v, Index w) {
      auto& ends = scene.border_neighbours[v];
      (ends[0] == no_index ? ends[0] : ends[1]) = w;
    };
    for (const Edge& edge : edges)
      if (edge.uses == 1) add(edge.a, edge.b), add(edge.b, edge.a);
  }
  if (options.irregular) {
    scene.dot_radius = std::min(0.22f * mean, size / 110);
    scene.regular_face = degrees.regular_face;
    scene.irregular.assign(mesh.positions.size(), 0);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      if (degrees.irregular(v))
        scene.irregular[v] = degrees.neighbours[v] < degrees.regular ? -1 : 1;
  }
}

}  // namespace

Scene make_scene(const Mesh& mesh, const PictureOptions& options, const Context& context) {
  Scene scene;
  scene.faces = &mesh.faces;
  project(mesh, options, scene);
  if (scene.points.empty()) return scene;
  if (mesh.is_point_cloud()) {
    // As large as their mean distance, if they cover about half of the image evenly.
    const float size = float(std::min(options.width, options.height)) * options.zoom;
    const float spacing = 0.9f * size / std::sqrt(float(scene.points.size()));
    scene.dot_radius = std::clamp(0.75f * spacing, 0.8f, size / 60);
    return scene;
  }
  scene.triangles = triangles_of(mesh);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 2; k < mesh.faces.degree(f); ++k)
      scene.face_of.push_back(static_cast<Index>(f));
  add_normals(scene, context);
  add_marks(mesh, options, scene);
  return scene;
}

}  // namespace meshgrain::picture
