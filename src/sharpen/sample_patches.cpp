#include "sharpen/sample_patches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <unordered_map>
#include <vector>

#include "util/collect.h"

namespace meshgrain {
namespace {

struct Ball {
  Vec3 center;
  float radius2;
};

/// Around the middle one of some faces that follow each other, with room for so many of their size.
Ball ball_around(const Mesh& mesh, std::size_t middle, std::size_t size) {
  constexpr std::size_t to_each_side = 32;
  const std::size_t begin = middle - std::min(middle, to_each_side);
  const std::size_t end = std::min(middle + to_each_side, mesh.faces.size());
  double area = 0;
  for (std::size_t f = begin; f < end; ++f) {
    const auto face = mesh.faces[f];
    const Vec3& a = mesh.positions[face[0]];
    area += (mesh.positions[face[1]] - a).cross(mesh.positions[face[2]] - a).norm() / 2;
  }
  const double wanted = area * static_cast<double>(size) / static_cast<double>(end - begin);
  return {mesh.positions[mesh.faces[middle][0]], static_cast<float>(wanted / std::numbers::pi)};
}

constexpr std::uint8_t no_ball = 255;

/// The first ball that each vertex is in.
std::vector<std::uint8_t> ball_of_vertices(const Mesh& mesh, std::span<const Ball> balls,
                                           const Context& context) {
  constexpr std::size_t grain = 8192, block = 64;
  std::vector<std::uint8_t> result(mesh.positions.size(), no_ball);
  const auto look_at_block = [&](std::size_t begin, std::size_t end) {
    // Vertices that follow each other are near each other as a rule, and all far from most balls.
    Eigen::AlignedBox3f box;
    for (std::size_t v = begin; v < end; ++v) box.extend(mesh.positions[v]);
    for (std::size_t k = balls.size(); k-- > 0;) {
      const auto& [center, radius2] = balls[k];
      constexpr float rounding = 1e-5f;
      if (box.squaredExteriorDistance(center) > radius2 * (1 + rounding)) continue;
      for (std::size_t v = begin; v < end; ++v) {
        const bool inside = (mesh.positions[v] - center).squaredNorm() <= radius2;
        if (inside) result[v] = static_cast<std::uint8_t>(k);
      }
    }
  };
  context.for_ranges(result.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; v += block) look_at_block(v, std::min(v + block, end));
  });
  return result;
}

}  // namespace

Mesh sample_patches(const Mesh& triangles, std::size_t count, std::size_t size,
                    const Context& context) {
  if (triangles.faces.size() <= count * size) return triangles;
  std::vector<Ball> balls;
  for (std::size_t k = 0; k < std::min<std::size_t>(count, no_ball); ++k) {
    balls.push_back(
        ball_around(triangles, (2 * k + 1) * triangles.faces.size() / (2 * count), size));
  }
  const std::vector<std::uint8_t> ball_of = ball_of_vertices(triangles, balls, context);
  const auto faces = collect<Index>(
      triangles.faces.size(),
      [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
        for (auto f = static_cast<Index>(begin); f < end; ++f) {
          const auto face = triangles.faces[f];
          const std::uint8_t ball = ball_of[face[0]];
          if (ball == no_ball || ball_of[face[1]] != ball || ball_of[face[2]] != ball) continue;
          found.push_back(f);
        }
      },
      context);
  // A ball may hold far more where a mesh is much finer than in the middle of it.
  const std::size_t most = 4 * size;
  std::vector<std::size_t> taken(balls.size(), 0);
  std::unordered_map<Index, Index> number;
  Mesh result;
  for (const Index f : faces) {
    if (taken[ball_of[triangles.faces[f][0]]]++ >= most) continue;
    std::array<Index, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index v = triangles.faces[f][k];
      const auto [at, is_new] = number.emplace(v, static_cast<Index>(result.positions.size()));
      if (is_new) result.positions.push_back(triangles.positions[v]);
      corners[k] = at->second;
    }
    result.faces.push_back(corners);
  }
  return result;
}

}  // namespace meshgrain
