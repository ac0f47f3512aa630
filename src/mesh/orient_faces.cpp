#include "mesh/orient_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/border.h"
#include "mesh/sort_by_vertex.h"
#include "util/hash.h"
#include "util/sum.h"

namespace meshgrain {
namespace {

using Vec3d = Eigen::Vector3d;

/// Whether every edge is used as often in one direction as in the other: so it is in a closed mesh
/// whose faces agree. Much faster than to look at each edge.
bool is_balanced(const Mesh& mesh, const Context& context) {
  return with_corners(mesh.faces, [&](const auto& corners) {
    const auto excess = [&](std::size_t begin, std::size_t end) {
      std::uint64_t sum = 0;  // of a random number for each edge, up or down
      for (std::size_t f = begin; f < end; ++f) {
        const auto face = corners(f);
        Index from = face.back();
        for (const Index to : face) {
          // Without branches, as no one could predict them.
          const std::uint64_t low = std::min(from, to), high = std::max(from, to);
          const std::uint64_t number = hash64(low << 32 | high);
          const std::uint64_t down = -std::uint64_t{to < from};  // all bits, or none
          sum += (number ^ down) - down;
          from = to;
        }
      }
      return sum;
    };
    return sum_over_ranges(mesh.faces.size(), excess, context) == 0;
  });
}

/// The faces with those across their edges.
class Neighbors {
 public:
  struct Neighbor {
    Index face;
    bool agrees;
  };

  Neighbors(std::size_t faces, const std::vector<TwoFacedEdge>& edges) : offsets_(faces + 1, 0) {
    for (const TwoFacedEdge& edge : edges) {
      for (const Index f : edge.faces) ++offsets_[f + 1];
    }
    for (std::size_t f = 0; f < faces; ++f) offsets_[f + 1] += offsets_[f];
    neighbors_.resize(offsets_.back());
    std::vector<std::size_t> next(offsets_.begin(), offsets_.end() - 1);
    for (const auto& [ends, pair, agree] : edges) {
      neighbors_[next[pair[0]]++] = {pair[1], agree};
      neighbors_[next[pair[1]]++] = {pair[0], agree};
    }
  }

  std::span<const Neighbor> operator[](Index f) const {
    return {neighbors_.data() + offsets_[f], offsets_[f + 1] - offsets_[f]};
  }

 private:
  std::vector<std::size_t> offsets_;
  std::vector<Neighbor> neighbors_;
};

class Orienting {
 public:
  Orienting(Mesh& mesh, const std::vector<TwoFacedEdge>& edges)
      : mesh_(mesh), neighbors_(mesh.faces.size(), edges), side_(mesh.faces.size(), unknown) {
    centers_.reserve(mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      Vec3d sum = Vec3d::Zero();
      for (const Index v : corners(f)) sum += mesh.positions[v].cast<double>();
      centers_.push_back(sum / static_cast<double>(mesh.faces.degree(f)));
    }
  }

  OrientReport run(const Context& context) {
    OrientReport report;
    for (Index f = 0; f < side_.size(); ++f) {
      if (side_[f] != unknown) continue;
      context.check();
      const std::vector<Index> piece = walk(f);
      report.one_sided_pieces += is_one_sided(piece);
      turn(piece, report.turned_faces);
    }
    return report;
  }

 private:
  enum Side : std::uint8_t { as_it_is, turned, unknown };

  std::span<const Index> corners(std::size_t f) const { return std::as_const(mesh_.faces)[f]; }
  Side across(Side side, bool agrees) const {
    return agrees == (side == as_it_is) ? as_it_is : turned;
  }

  /// The faces that hang together with one, their sides found from it in the order of their
  /// distance: in a piece without two sides the fronts then meet along a short curve.
  std::vector<Index> walk(Index first) {
    struct Step {
      double distance;
      Index face, from;
      bool agrees;
      bool operator>(const Step& o) const {
        return std::tie(distance, face, from) > std::tie(o.distance, o.face, o.from);
      }
    };
    std::priority_queue<Step, std::vector<Step>, std::greater<>> queue;
    std::vector<Index> piece;
    const auto take = [&](Index f, Side side, double distance) {
      side_[f] = side;
      piece.push_back(f);
      for (const auto& [g, agrees] : neighbors_[f]) {
        if (side_[g] == unknown) {
          queue.push({distance + (centers_[f] - centers_[g]).norm(), g, f, agrees});
        }
      }
    };
    take(first, as_it_is, 0);
    while (!queue.empty()) {
      const Step step = queue.top();
      queue.pop();
      if (side_[step.face] != unknown) continue;
      take(step.face, across(side_[step.from], step.agrees), step.distance);
    }
    return piece;
  }

  bool is_one_sided(const std::vector<Index>& piece) const {
    return std::ranges::any_of(piece, [&](Index f) {
      return std::ranges::any_of(neighbors_[f], [&](const Neighbors::Neighbor& neighbor) {
        return side_[neighbor.face] != across(side_[f], neighbor.agrees);
      });
    });
  }

  /// Twice the area vector of a face.
  Vec3d area_vector(Index f) const {
    const auto face = corners(f);
    const auto position = [&](std::size_t k) -> Vec3d {
      return mesh_.positions[face[k]].cast<double>() - centers_[f];
    };
    Vec3d sum = Vec3d::Zero();
    for (std::size_t k = 0; k < face.size(); ++k) {
      sum += position(k).cross(position((k + 1) % face.size()));
    }
    return sum;
  }

  void turn(const std::vector<Index>& piece, std::size_t& turned_faces) {
    constexpr double clearly = 3;  // times the area of the other side
    double area[2] = {0, 0}, volume = 0;
    Vec3d middle = Vec3d::Zero();
    for (const Index f : piece) middle += centers_[f] / static_cast<double>(piece.size());
    for (const Index f : piece) {
      const Vec3d normal = area_vector(f);
      area[side_[f]] += normal.norm();
      volume += (side_[f] == as_it_is ? 1 : -1) * normal.dot(centers_[f] - middle);
    }
    const bool is_clear = std::max(area[0], area[1]) > clearly * std::min(area[0], area[1]);
    const bool keep = is_clear ? area[as_it_is] > area[turned] : volume >= 0;
    for (const Index f : piece) {
      if ((side_[f] == as_it_is) == keep) continue;
      const std::span<Index> face = mesh_.faces[f];
      std::reverse(face.begin() + 1, face.end());
      ++turned_faces;
    }
  }

  Mesh& mesh_;
  const Neighbors neighbors_;
  std::vector<Side> side_;
  std::vector<Vec3d> centers_;
};

}  // namespace

OrientReport orient_faces(Mesh& mesh, const Context& context) {
  if (is_balanced(mesh, context)) return {.may_have_border = false};
  if (!disagree_somewhere(mesh, context)) return {};
  return Orienting(mesh, two_faced_edges(mesh, context)).run(context);
}

}  // namespace meshgrain
