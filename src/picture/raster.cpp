#include "picture/raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meshgrain::picture {
namespace {

/// The samples of [low, high] (in pixels, from `origin`) along one axis of `count` samples.
struct SampleRange {
  int begin, end;
  SampleRange(float low, float high, float origin, int count) {
    const auto first = std::ceil((low - origin) * supersampling - 0.5f);
    const auto last = std::floor((high - origin) * supersampling - 0.5f);
    begin = static_cast<int>(std::clamp(first, 0.0f, float(count)));
    end = static_cast<int>(std::clamp(last + 1, 0.0f, float(count)));
  }
};

void draw_triangle(const Scene& scene, Index t, Band& band) {
  const Vec3 a = scene.points[scene.triangles[t][0]], b = scene.points[scene.triangles[t][1]],
             c = scene.points[scene.triangles[t][2]];
  const SampleRange columns(std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()}), 0,
                            band.sample_width);
  const SampleRange rows(std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()}),
                         float(band.first_row), band.rows * supersampling);
  // Double precision: neighbours must not leave gaps along an edge that is far longer than a pixel.
  const double bx = double(b.x()) - a.x(), by = double(b.y()) - a.y();
  const double cx = double(c.x()) - a.x(), cy = double(c.y()) - a.y();
  const double area = bx * cy - by * cx;
  if (area == 0) return;
  for (int j = rows.begin; j < rows.end; ++j)
    for (int i = columns.begin; i < columns.end; ++i) {
      const Eigen::Vector2f at = band.place(i, j);
      const double px = double(at.x()) - a.x(), py = double(at.y()) - a.y();
      const double v = (px * cy - py * cx) / area, w = (bx * py - by * px) / area;
      if (v < -1e-9 || w < -1e-9 || v + w > 1 + 1e-9) continue;
      const float z = float(a.z() + v * (b.z() - a.z()) + w * (c.z() - a.z()));
      const std::size_t sample = std::size_t(j) * band.sample_width + i;
      if (z <= band.depth[sample]) continue;
      band.depth[sample] = z;
      band.item[sample] = t;
    }
}

/// A small ball: it hides those behind it even where points are dense.
void draw_point(const Scene& scene, Index v, Band& band) {
  const Vec3 p = scene.points[v];
  const float r = scene.dot_radius;
  const SampleRange columns(p.x() - r, p.x() + r, 0, band.sample_width);
  const SampleRange rows(p.y() - r, p.y() + r, float(band.first_row), band.rows * supersampling);
  for (int j = rows.begin; j < rows.end; ++j)
    for (int i = columns.begin; i < columns.end; ++i) {
      const float d2 = (band.place(i, j) - p.head<2>()).squaredNorm();
      if (d2 > r * r) continue;
      const float z = p.z() + std::sqrt(r * r - d2);
      const std::size_t sample = std::size_t(j) * band.sample_width + i;
      if (z <= band.depth[sample]) continue;
      band.depth[sample] = z;
      band.item[sample] = v;
    }
}

}  // namespace

Bands::Bands(const Scene& scene, int width, int height, int rows)
    : scene_(scene), width_(width), height_(height), rows_(rows) {
  const bool cloud = scene.triangles.empty();
  const std::size_t count = cloud ? scene.points.size() : scene.triangles.size();
  const int bands = (height + rows - 1) / rows;
  // The bands [first, last] of an item, none if it lies outside the image.
  const auto range = [&](std::size_t item) {
    Vec3 low, high;
    if (cloud) {
      low = scene.points[item] - Vec3::Constant(scene.dot_radius);
      high = scene.points[item] + Vec3::Constant(scene.dot_radius);
    } else {
      const auto [a, b, c] = scene.triangles[item];
      const auto& p = scene.points;
      low = p[a].cwiseMin(p[b]).cwiseMin(p[c]);
      high = p[a].cwiseMax(p[b]).cwiseMax(p[c]);
      if (!(p[a] + p[b] + p[c]).allFinite()) return std::pair(1, 0);
    }
    const bool seen = high.x() >= 0 && low.x() <= float(width) && high.y() >= 0 &&
                      low.y() <= float(height) && low.allFinite();
    if (!seen) return std::pair(1, 0);
    const auto band_at = [&](float y) {
      return static_cast<int>(std::clamp(y / float(rows), 0.0f, float(bands - 1)));
    };
    return std::pair(band_at(low.y()), band_at(high.y()));
  };
  end_.assign(bands + 1, 0);
  std::vector<std::size_t> next(bands + 1, 0);
  for (std::size_t item = 0; item < count; ++item) {
    const auto [first, last] = range(item);
    for (int b = first; b <= last; ++b) ++end_[b + 1];
  }
  for (int b = 0; b < bands; ++b) next[b] = end_[b], end_[b + 1] += end_[b];
  items_.resize(end_.back());
  for (std::size_t item = 0; item < count; ++item) {
    const auto [first, last] = range(item);
    for (int b = first; b <= last; ++b) items_[next[b]++] = static_cast<Index>(item);
  }
}

Band Bands::draw(std::size_t b) const {
  Band band;
  band.first_row = static_cast<int>(b) * rows_;
  band.rows = std::min(rows_, height_ - band.first_row);
  band.sample_width = width_ * supersampling;
  const std::size_t samples = std::size_t(band.sample_width) * band.rows * supersampling;
  band.depth.assign(samples, -std::numeric_limits<float>::infinity());
  band.item.assign(samples, no_index);
  for (std::size_t i = end_[b]; i < end_[b + 1]; ++i) {
    if (scene_.triangles.empty())
      draw_point(scene_, items_[i], band);
    else
      draw_triangle(scene_, items_[i], band);
  }
  return band;
}

}  // namespace meshgrain::picture
