#include "picture/shade.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "util/triangle.h"

namespace meshgrain::picture {
namespace {

using Vec2 = Eigen::Vector2f;

const Vec3 clay(0.56f, 0.61f, 0.69f), inside(0.72f, 0.30f, 0.24f), odd_face(0.95f, 0.78f, 0.30f);
const Vec3 ink(0.02f, 0.025f, 0.04f), border_red(0.75f, 0.02f, 0.02f);
const Vec3 fewer_red(0.80f, 0.02f, 0.03f), more_blue(0.02f, 0.12f, 0.75f);

float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// The share of a pixel at distance `d` from the middle of something `radius` wide to each side.
float coverage(float radius, float d) {
  return std::clamp(radius + 0.5f - d, 0.0f, 1.0f);
}

void blend(Vec3& colour, const Vec3& with, float share) {
  colour += share * (with - colour);
}

/// A warm main light from the upper left, a cool fill from the right, and the sky and the ground.
Vec3 light(const Vec3& base, const Vec3& n) {
  static const Vec3 key = Vec3(-0.42f, -0.80f, 0.56f).normalized();
  static const Vec3 fill = Vec3(0.85f, -0.05f, 0.45f).normalized();
  static const Vec3 half = (key + Vec3::UnitZ()).normalized();
  const float up = 0.5f - 0.5f * n.y();
  const Vec3 sky(0.30f, 0.335f, 0.40f), ground(0.19f, 0.175f, 0.165f);
  const Vec3 all = ground + up * (sky - ground) +
                   std::max(0.0f, (n.dot(key) + 0.12f) / 1.12f) * Vec3(1.02f, 0.95f, 0.84f) +
                   std::max(0.0f, n.dot(fill)) * Vec3(0.10f, 0.13f, 0.18f);
  const float shine = 0.10f * std::pow(std::max(0.0f, n.dot(half)), 40.0f);
  const float limb = 0.72f + 0.28f * smooth_step(0, 0.6f, n.z());  // sets it off from the white
  return limb * base.cwiseProduct(all) + Vec3::Constant(shine);
}

/// How far the corners of a face are apart where they are closest, roughly, as seen.
float apparent_width(const Scene& scene, std::span<const Index> face) {
  float twice_area = 0, longest = 0;
  for (std::size_t k = 0; k < face.size(); ++k) {
    const Vec3 &a = scene.points[face[k]], &b = scene.points[face[(k + 1) % face.size()]];
    const Vec3& o = scene.points[face[0]];
    twice_area += (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
    longest = std::max(longest, (a - b).head<2>().norm());
  }
  const float width = std::abs(twice_area) / std::max(longest, 1e-6f);
  return face.size() == 3 ? width : width / 2;
}

void draw_marks(const Scene& scene, std::span<const Index> face, const Vec3& p, Vec3& colour) {
  const Vec2 place = p.head<2>();
  const float width = apparent_width(scene, face);
  const float line = scene.line_strength * smooth_step(1.0f, 6.0f, width);
  const std::size_t n = face.size();
  if (scene.line_width > 0 && line > 0) {
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < n; ++k) {
      const Vec2 a = scene.points[face[k]].head<2>(), b = scene.points[face[(k + 1) % n]].head<2>();
      nearest = std::min(nearest, (closest_point_on_segment(place, a, b) - place).norm());
    }
    blend(colour, ink, line * coverage(scene.line_width / 2, nearest));
  }
  if (scene.border_width > 0) {
    // A border runs on one side only, so it takes its whole width there. A face that only touches
    // the border at a vertex draws its part of the border's edges there.
    float nearest = std::numeric_limits<float>::infinity();
    for (Index v : face)
      for (Index w : scene.border_neighbours[v]) {
        if (w == no_index) continue;
        const Vec2 a = scene.points[v].head<2>(), b = scene.points[w].head<2>();
        nearest = std::min(nearest, (closest_point_on_segment(place, a, b) - place).norm());
      }
    blend(colour, border_red, coverage(scene.border_width, nearest));
  }
  const bool dots = !scene.irregular.empty() && scene.dot_radius > 1.2f;
  if (dots) {
    const float dot = smooth_step(1.2f, 2.2f, scene.dot_radius);
    for (Index v : face) {
      if (scene.irregular[v] == 0) continue;
      // In space, not in the image: the dot lies on the surface.
      const float d = (scene.points[v] - p).norm();
      blend(colour, Vec3::Constant(0.9f), 0.8f * dot * coverage(scene.dot_radius + 0.9f, d));
      blend(colour, scene.irregular[v] < 0 ? fewer_red : more_blue,
            dot * coverage(scene.dot_radius, d));
    }
  }
}

}  // namespace

Sample shade_triangle(const Scene& scene, Index triangle, const Vec2& place) {
  const Triangle corners = scene.triangles[triangle];
  const Vec3 a = scene.points[corners[0]];
  const Vec3 ab = scene.points[corners[1]] - a, ac = scene.points[corners[2]] - a;
  const Vec2 ap = place - a.head<2>();
  const float area = ab.x() * ac.y() - ab.y() * ac.x();
  const float v = std::clamp((ap.x() * ac.y() - ap.y() * ac.x()) / area, 0.0f, 1.0f);
  const float w = std::clamp((ab.x() * ap.y() - ab.y() * ap.x()) / area, 0.0f, 1.0f - v);
  const Vec3 p(place.x(), place.y(), a.z() + v * ab.z() + w * ac.z());
  const Vec3* normals = &scene.normals[3 * std::size_t(triangle)];
  Vec3 n = (1 - v - w) * normals[0] + v * normals[1] + w * normals[2];
  n = n.stableNormalized();
  const bool back = area > 0;  // the y axis points down: front faces turn clockwise
  if (back) n = -n;
  // An interpolated normal may point away from the eye near the outline.
  if (n.z() < 0) n = Vec3(n.x(), n.y(), 0).stableNormalized();

  const auto face = (*scene.faces)[scene.face_of[triangle]];
  const bool odd = scene.regular_face != 0 && face.size() != scene.regular_face;
  const Vec3 base = back ? inside : odd ? odd_face : clay;
  Sample sample{light(base, n), n};
  draw_marks(scene, face, p, sample.colour);
  return sample;
}

Sample shade_point(const Scene& scene, Index point, const Vec2& place) {
  const Vec2 offset = (place - scene.points[point].head<2>()) / scene.dot_radius;
  Vec3 n(offset.x(), offset.y(), std::sqrt(std::max(0.0f, 1 - offset.squaredNorm())));
  if (scene.normals.empty()) return {light(clay, n), n};
  // A disc with a dark rim in the light of its normal.
  Vec3 normal = scene.normals[point].stableNormalized();
  const bool back = normal.z() < 0;
  if (back) normal = -normal;
  return {(0.7f + 0.3f * n.z()) * light(back ? inside : clay, normal), normal};
}

}  // namespace meshgrain::picture
