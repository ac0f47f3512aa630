#include "features/clean_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "util/union_find.h"

namespace meshgrain {
namespace {

/// The edges sharper than some angle, and those beside them that are not flat.
class Lines {
 public:
  Lines(const Mesh& mesh, const RimAndSharpEdges& edges, double degrees, Beside beside)
      : mesh_(mesh), beside_(beside), on_rim_(mesh.positions.size(), 0) {
    for (const auto& [a, b] : edges.rim) on_rim_[a] = on_rim_[b] = 1;
    const double flattest = std::cos(degrees * std::numbers::pi / 180);
    std::vector<std::uint8_t> on_line(mesh.positions.size(), 0);
    for (const auto& [ends, cosine] : edges.sharp) {
      if (cosine < flattest) on_line[ends[0]] = on_line[ends[1]] = 1;
    }
    for (const auto& [ends, cosine] : edges.sharp) {
      if (!on_line[ends[0]] && !on_line[ends[1]]) continue;
      const auto e = static_cast<Index>(edges_.size());
      const double angle = std::acos(std::max(-1.0, cosine)) * 180 / std::numbers::pi;
      edges_.push_back({ends, angle, cosine < flattest});
      for (const Index v : ends) {
        if (on_line[v]) at_.push_back({v, e});
      }
    }
    std::sort(at_.begin(), at_.end());
  }

  double clean_share() const {
    UnionFind whole(edges_.size());  // edges that were one before they were split
    std::vector<Index> unclean;
    for (std::size_t k = 0; k < at_.size();) {
      const std::size_t first = k;
      while (k < at_.size() && at_[k].vertex == at_[first].vertex) ++k;
      const std::span<const Incidence> here(&at_[first], k - first);
      if (is_within_an_edge(here)) {
        whole.unite(here[0].edge, here[1].edge);
        continue;
      }
      for (const Incidence& i : here) {
        if (edges_[i.edge].is_sharp && !has_clean_end(i, here)) unclean.push_back(i.edge);
      }
    }
    std::vector<std::uint8_t> is_unclean(edges_.size(), 0);
    for (const Index e : unclean) is_unclean[whole.find(e)] = 1;
    double clean = 0, all = 0;
    for (Index e = 0; e < edges_.size(); ++e) {
      if (!edges_[e].is_sharp) continue;
      const auto [a, b] = edges_[e].ends;
      const double length = (mesh_.positions[a] - mesh_.positions[b]).norm();
      all += length;
      if (!is_unclean[whole.find(e)]) clean += length;
    }
    return all > 0 ? clean / all : 0;
  }

 private:
  struct Edge {
    std::array<Index, 2> ends;
    double angle;  // between the normals of its faces, in degrees
    bool is_sharp;
  };
  struct Incidence {
    Index vertex, edge;
    auto operator<=>(const Incidence&) const = default;
  };

  /// The unit vector from a vertex along an edge.
  Vec3 along(Index e, Index vertex) const {
    const auto [a, b] = edges_[e].ends;
    const Index other = a == vertex ? b : a;
    return (mesh_.positions[other] - mesh_.positions[vertex]).normalized();
  }

  /// How straight one edge goes on in another: the cosine of the angle in between.
  float straightness(Index e, Index other, Index vertex) const {
    return -along(e, vertex).dot(along(other, vertex));
  }

  bool is_within_an_edge(std::span<const Incidence> here) const {
    constexpr float straight = 0.9999f;
    constexpr double same = 0.1;  // degrees
    if (here.size() != 2) return false;
    const Edge &a = edges_[here[0].edge], &b = edges_[here[1].edge];
    return a.is_sharp && b.is_sharp && std::abs(a.angle - b.angle) < same &&
           straightness(here[0].edge, here[1].edge, here[0].vertex) > straight;
  }

  bool has_clean_end(const Incidence& end, std::span<const Incidence> here) const {
    constexpr std::ptrdiff_t at_corner = 3;
    constexpr double much_flatter = 1.0 / 3, much_flatter_facets = 0.46;
    const double angle = edges_[end.edge].angle;
    const bool may_be_facets = beside_ == Beside::facets && angle >= about_right_degrees;
    const double bound = (may_be_facets ? much_flatter_facets : much_flatter) * angle;
    std::ptrdiff_t sharp = 0;
    for (const Incidence& i : here) {
      const Edge& edge = edges_[i.edge];
      if (!edge.is_sharp && edge.angle >= bound) return false;
      sharp += edge.is_sharp;
    }
    return sharp >= at_corner || on_rim_[end.vertex] || (sharp == 2 && goes_on(end, here));
  }

  bool goes_on(const Incidence& end, std::span<const Incidence> here) const {
    constexpr float about_straight = 0.64f;  // 50 degrees
    constexpr double as_sharp = 0.7;
    const double angle = edges_[end.edge].angle;
    return std::ranges::any_of(here, [&](const Incidence& i) {
      const Edge& other = edges_[i.edge];
      return i.edge != end.edge && other.is_sharp &&
             std::min(angle, other.angle) > as_sharp * std::max(angle, other.angle) &&
             straightness(end.edge, i.edge, end.vertex) > about_straight;
    });
  }

  const Mesh& mesh_;
  Beside beside_;
  std::vector<Edge> edges_;
  std::vector<Incidence> at_;  // sorted
  std::vector<std::uint8_t> on_rim_;
};

}  // namespace

double share_of_clean_lines(const Mesh& triangles, const RimAndSharpEdges& edges, double degrees,
                            Beside beside) {
  return Lines(triangles, edges, degrees, beside).clean_share();
}

}  // namespace meshgrain
