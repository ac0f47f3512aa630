#include "sharpen/normal_filter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/border.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 128;
constexpr std::size_t cheap_grain = 8192;  // for loops that take no longer than waking a thread

}  // namespace

NormalFilter::NormalFilter(Mesh& triangles, Border border, const Context& context)
    : mesh_(triangles), context_(context), vertex_faces_(vertex_faces(triangles, context)) {
  const std::size_t count = mesh_.faces.size();
  const auto ring = [&](std::size_t f, std::vector<Index>& faces) {
    faces.clear();
    for (const Index v : std::as_const(mesh_.faces)[f]) {
      faces.insert(faces.end(), vertex_faces_[v].begin(), vertex_faces_[v].end());
    }
    sort_unique(faces);
  };
  starts_.assign(count + 1, 0);
  context_.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    std::vector<Index> faces;
    for (std::size_t f = begin; f < end; ++f) {
      ring(f, faces);
      starts_[f + 1] = faces.size();
    }
  });
  for (std::size_t f = 0; f < count; ++f) starts_[f + 1] += starts_[f];
  neighbors_.resize(starts_[count]);
  context_.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    std::vector<Index> faces;
    for (std::size_t f = begin; f < end; ++f) {
      ring(f, faces);
      std::copy(faces.begin(), faces.end(), neighbors_.data() + starts_[f]);
    }
  });
  stays_.assign(mesh_.positions.size(), 0);
  if (border == Border::stays) {
    for (const auto& ends : rim_edges(mesh_, context)) {
      for (const Index v : ends) stays_[v] = 1;
    }
  }
  facets_.resize(count);
  patches_.resize(count);
  guides_.resize(count);
  normals_.resize(count);
  offsets_.resize(count);
}

void NormalFilter::run(int end) {
  // Wide at first, to agree across the noise; then narrow, so that faces in between decide for one
  // side of a crease.
  constexpr int moves = 10;
  constexpr float first_spread = 0.4f, last_spread = 0.2f;
  for (; round_ < end; ++round_) {
    context_.progress("sharpen", static_cast<double>(round_) / rounds);
    measure_facets();
    measure_patches();
    const float share = static_cast<float>(round_) / (rounds - 1);
    average(mean_reach(), first_spread + share * (last_spread - first_spread));
    for (int move = 0; move < moves; ++move) move_vertices();
  }
}

void NormalFilter::measure_facets() {
  context_.for_ranges(facets_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto face = std::as_const(mesh_.faces)[f];
      const Vec3 &a = mesh_.positions[face[0]], &b = mesh_.positions[face[1]],
                 &c = mesh_.positions[face[2]];
      const Vec3 cross = (b - a).cross(c - a);
      const float length = cross.norm();
      facets_[f] = {length > 0 ? Vec3(cross / length) : Vec3(Vec3::Zero()), (a + b + c) / 3,
                    length / 2};
    }
  });
}

/// How far a face and its neighbours are from one plane: the largest deviation of a normal, times
/// how much of the change from face to face comes from a single one, as it does at a crease.
void NormalFilter::measure_patches() {
  context_.for_ranges(facets_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      Vec3 normal = Vec3::Zero();
      for (const Index g : around(f)) normal += facets_[g].area * facets_[g].normal;
      normal.normalize();
      float deviation = 0, largest = 0, sum = 1e-9f;
      for (const Index g : around(f)) {
        deviation = std::max(deviation, (facets_[g].normal - normal).norm());
        const float step = (facets_[g].normal - facets_[f].normal).norm();
        largest = std::max(largest, step);
        sum += step;
      }
      patches_[f] = {normal, deviation * largest / sum};
    }
  });
  context_.for_ranges(facets_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      auto best = static_cast<Index>(f);
      for (const Index g : around(f)) {
        if (patches_[g].unevenness < patches_[best].unevenness) best = g;
      }
      guides_[f] = patches_[best].normal;
    }
  });
}

float NormalFilter::mean_reach() const {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t f = 0; f < facets_.size(); f += 7) {  // a sample will do
    for (const Index g : around(f)) sum += (facets_[f].center - facets_[g].center).norm();
    count += around(f).size() - 1;
  }
  return static_cast<float>(sum / static_cast<double>(std::max<std::size_t>(count, 1)));
}

void NormalFilter::average(float reach, float spread) {
  context_.for_ranges(facets_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      Vec3 sum = Vec3::Zero();
      for (const Index g : around(f)) {
        const float apart = (facets_[f].center - facets_[g].center).squaredNorm() / (reach * reach);
        const float turned = (guides_[f] - guides_[g]).squaredNorm() / (spread * spread);
        sum += facets_[g].area * std::exp(-(apart + turned) / 2) * facets_[g].normal;
      }
      const float length = sum.norm();
      normals_[f] = length > 0 ? Vec3(sum / length) : facets_[f].normal;
    }
  });
}

void NormalFilter::move_vertices() {
  // The plane that each face should lie in goes through its center.
  context_.for_ranges(facets_.size(), cheap_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto face = std::as_const(mesh_.faces)[f];
      const Vec3 sum =
          mesh_.positions[face[0]] + mesh_.positions[face[1]] + mesh_.positions[face[2]];
      offsets_[f] = normals_[f].dot(sum) / 3;
    }
  });
  context_.for_ranges(mesh_.positions.size(), cheap_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (stays_[v] || vertex_faces_[v].empty()) continue;
      Vec3& p = mesh_.positions[v];
      Vec3 sum = Vec3::Zero();
      for (const Index f : vertex_faces_[v])
        sum += normals_[f] * (offsets_[f] - normals_[f].dot(p));
      p += sum / static_cast<float>(vertex_faces_[v].size());
    }
  });
}

}  // namespace meshgrain
