#include "cloud/outliers.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include "cloud/spacing.h"
#include "mesh/keep_vertices.h"
#include "util/collect.h"

namespace meshgrain {
namespace {

/// Whether they lie about in a plane, or on a line.
bool is_flat(std::span<const Vec3> points, std::span<const Index> some) {
  constexpr double flat = 0.03;  // of the variance; a sheet bent by 90 degrees over them has 0.05
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Index i : some) mean += points[i].cast<double>();
  mean /= static_cast<double>(some.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Index i : some) {
    const Eigen::Vector3d d = points[i].cast<double>() - mean;
    covariance += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0] <= flat * covariance.trace();
}

}  // namespace

std::vector<Index> find_outliers(std::span<const Vec3> points, const Neighborhoods& nearest,
                                 const Context& context) {
  constexpr float sparse = 6, alike = 4;  // times as far from the neighbours
  constexpr std::size_t most = 5;         // one in so many points
  const std::vector<float> squares = squared_distances(points, nearest, context);
  const float limit = sparse * sparse * median(squares);
  const auto find = [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
    std::vector<Index> others;
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      if (!(squares[i] > limit)) continue;
      others.assign(1, i);
      for (const Index j : nearest[i]) {
        if (squares[j] * alike * alike >= squares[i]) others.push_back(j);
      }
      const bool is_alone = 2 * others.size() <= nearest[i].size();
      if (is_alone || !is_flat(points, others)) out.push_back(i);
    }
  };
  std::vector<Index> found = collect<Index>(points.size(), find, context);
  if (found.size() * most > points.size()) found.clear();
  return found;
}

std::size_t drop_outliers(Mesh& cloud, Neighborhoods& nearest, const Context& context) {
  constexpr int rounds = 8;
  const std::size_t before = cloud.positions.size();
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Index> outliers = find_outliers(cloud.positions, nearest, context);
    if (outliers.empty()) break;
    std::vector<Index> kept(cloud.positions.size());
    std::iota(kept.begin(), kept.end(), Index{0});
    std::erase_if(kept, [&](Index i) { return std::ranges::binary_search(outliers, i); });
    keep_vertices(cloud, kept);
    nearest = nearest_neighbors(cloud.positions, nearest.k, context);
  }
  return before - cloud.positions.size();
}

}  // namespace meshgrain
