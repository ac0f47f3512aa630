#include "mesh/pair_around_edge.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace meshgrain {
namespace {

constexpr double same = 1e-3;  // radians

struct Spoke {
  double angle;  // around the edge, counterclockwise seen from its end
  std::size_t face;
};

/// The faces in the order of their angles, from the first one on.
std::vector<Spoke> sorted_by_angle(const Vec3& from, const Vec3& to,
                                   std::span<const FaceBesideEdge> faces) {
  const Eigen::Vector3d axis = (to - from).cast<double>().normalized();
  const auto across = [&](std::size_t f) -> Eigen::Vector3d {
    const Eigen::Vector3d d = (faces[f].corner - from).cast<double>();
    return d - axis * d.dot(axis);
  };
  const Eigen::Vector3d x = across(0), y = axis.cross(x);
  std::vector<Spoke> result;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Eigen::Vector3d d = across(f);
    double angle = std::atan2(d.dot(y), d.dot(x));
    if (angle < -same) angle += 2 * std::numbers::pi;
    result.push_back({angle, f});
  }
  std::ranges::stable_sort(result, {}, &Spoke::angle);
  return result;
}

using Pairs = std::vector<std::array<std::size_t, 2>>;

/// A face that runs against the edge has the inside before it, counterclockwise; one that runs
/// along it, behind it. They match like brackets, twice around as there is no first one.
Pairs pair_around_solids(std::vector<Spoke> spokes, std::span<const FaceBesideEdge> faces) {
  // Of faces that lie on each other, as the walls of two boxes, the one that ends a solid is first.
  for (auto begin = spokes.begin(); begin != spokes.end();) {
    auto end = begin + 1;
    while (end != spokes.end() && end->angle - (end - 1)->angle < same) ++end;
    std::stable_partition(begin, end, [&](const Spoke& s) { return faces[s.face].runs_along; });
    begin = end;
  }
  Pairs pairs;
  std::vector<std::size_t> open;
  std::vector<bool> is_closed(faces.size(), false);
  for (std::size_t k = 0; k < 2 * spokes.size(); ++k) {
    const std::size_t face = spokes[k % spokes.size()].face;
    if (!faces[face].runs_along) {
      if (k < spokes.size()) open.push_back(face);
    } else if (!is_closed[face] && !open.empty()) {
      is_closed[face] = true;
      pairs.push_back({face, open.back()});
      open.pop_back();
    }
  }
  return pairs;
}

/// Those first that lie flattest.
Pairs pair_flattest(const std::vector<Spoke>& spokes, std::span<const FaceBesideEdge> faces) {
  struct Candidate {
    double bend;
    std::array<std::size_t, 2> faces;
  };
  std::vector<Candidate> candidates;
  for (const Spoke& a : spokes) {
    for (const Spoke& b : spokes) {
      if (!faces[a.face].runs_along || faces[b.face].runs_along) continue;
      candidates.push_back({std::cos(a.angle - b.angle), {a.face, b.face}});
    }
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::bend);
  Pairs pairs;
  std::vector<bool> is_taken(faces.size(), false);
  for (const auto& [bend, pair] : candidates) {
    if (is_taken[pair[0]] || is_taken[pair[1]]) continue;
    is_taken[pair[0]] = is_taken[pair[1]] = true;
    pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace

std::vector<std::array<std::size_t, 2>> pair_around_edge(const Vec3& from, const Vec3& to,
                                                         std::span<const FaceBesideEdge> faces) {
  const auto along = std::ranges::count_if(faces, &FaceBesideEdge::runs_along);
  const std::vector<Spoke> spokes = sorted_by_angle(from, to, faces);
  return 2 * along == std::ssize(faces) ? pair_around_solids(spokes, faces)
                                        : pair_flattest(spokes, faces);
}

}  // namespace meshgrain
