#include "features/fading_creases.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace meshgrain {
namespace {

class FadingCreases {
 public:
  FadingCreases(const Mesh& mesh, std::span<const SharpEdge> edges,
                std::vector<std::uint8_t>& is_crease)
      : mesh_(mesh), edges_(edges), is_crease_(is_crease) {
    at_.reserve(2 * edges.size());
    for (Index e = 0; e < edges.size(); ++e) {
      for (const Index v : edges[e].ends) at_.push_back({v, e});
    }
    std::sort(at_.begin(), at_.end());
  }

  void follow() {
    std::vector<Incidence> ends;
    for (const Incidence& i : at_) {
      if (is_crease_[i.edge] && is_end(i.vertex)) ends.push_back(i);
    }
    for (Incidence end : ends) {
      while (is_end(end.vertex)) {
        const Index next = next_edge(end);
        if (next == no_index) break;
        is_crease_[next] = 1;
        end = {other_end(next, end.vertex), next};
      }
    }
  }

 private:
  struct Incidence {
    Index vertex, edge;
    auto operator<=>(const Incidence&) const = default;
  };

  std::span<const Incidence> around(Index vertex) const {
    const auto [first, last] = std::equal_range(
        at_.begin(), at_.end(), Incidence{vertex, 0},
        [](const Incidence& a, const Incidence& b) { return a.vertex < b.vertex; });
    return {first, last};
  }

  bool is_end(Index vertex) const {
    return std::ranges::count_if(around(vertex),
                                 [&](const Incidence& i) { return is_crease_[i.edge]; }) == 1;
  }

  Index other_end(Index e, Index vertex) const {
    const auto [a, b] = edges_[e].ends;
    return a == vertex ? b : a;
  }

  double angle(Index e) const { return std::acos(std::max(-1.0, edges_[e].cosine)); }

  /// How straight one edge goes on in another: the cosine of the angle in between.
  float straightness(Index e, Index other, Index vertex) const {
    const Vec3& p = mesh_.positions[vertex];
    const Vec3 from = p - mesh_.positions[other_end(e, vertex)];
    const Vec3 on = mesh_.positions[other_end(other, vertex)] - p;
    return from.normalized().dot(on.normalized());
  }

  /// In which a crease goes on at its end, or no_index.
  Index next_edge(const Incidence& end) const {
    constexpr double nearly_as_sharp = 0.6, much_flatter = 0.5;
    constexpr float about_straight = 0.82f;  // 35 degrees
    Index next = no_index;
    double sharpest = 0, second = 0;
    for (const Incidence& i : around(end.vertex)) {
      if (is_crease_[i.edge]) continue;
      second = std::max(second, std::min(sharpest, angle(i.edge)));
      if (angle(i.edge) <= sharpest) continue;
      sharpest = angle(i.edge);
      next = i.edge;
    }
    const bool goes_on = next != no_index && sharpest > nearly_as_sharp * angle(end.edge) &&
                         second < much_flatter * sharpest &&
                         straightness(end.edge, next, end.vertex) > about_straight;
    return goes_on ? next : no_index;
  }

  const Mesh& mesh_;
  std::span<const SharpEdge> edges_;
  std::vector<std::uint8_t>& is_crease_;
  std::vector<Incidence> at_;  // sorted
};

}  // namespace

void follow_fading_creases(const Mesh& triangles, std::span<const SharpEdge> edges,
                           std::vector<std::uint8_t>& is_crease) {
  FadingCreases(triangles, edges, is_crease).follow();
}

}  // namespace meshgrain
