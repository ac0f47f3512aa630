#include "cloud/orient_normals.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <vector>

namespace meshgrain {
namespace {

using Eigen::Vector3d;

/// An opinion on whether two parts agree in orientation (positive) or not, and how sure it is.
struct Vote {
  Index a, b;  // a < b
  float value;
};

/// What an edge of the neighbour graph says. Between two points of a circular arc the normals are
/// mirror images in the plane between them (Xie, Wang, Hua, Qin and Kaufman 2003), which tells the
/// sign even where the surface turns by more than a right angle and across thin plates. Sure are
/// edges tangent to both planes (which those across sharp edges and gaps are not) between points
/// with like planes (Hoppe et al. 1992).
float vote_of_edge(const Vec3& p, const Vec3& n, const Vec3& q, const Vec3& m) {
  const Vec3 edge = (q - p).normalized();
  const float mirrored = n.dot(m) - 2 * edge.dot(n) * edge.dot(m);
  const float off_plane = std::max(std::abs(edge.dot(n)), std::abs(edge.dot(m)));
  const float doubt = 1 - std::abs(n.dot(m)) + 2 * off_plane;
  return std::copysign(std::exp(-4 * doubt), mirrored);
}

std::vector<Vote> edge_votes(std::span<const Vec3> points, const Neighborhoods& neighborhoods,
                             std::span<const Vec3> normals, const Context& context) {
  // Each edge once: from its first end, or from the second if the first does not list it.
  const auto listed_twice = [&](Index i, Index j) {
    const std::span<const Index> back = neighborhoods[j];
    return j < i && std::find(back.begin(), back.end(), i) != back.end();
  };
  std::vector<std::size_t> starts(points.size() + 1, 0);
  constexpr std::size_t grain = 4096;
  context.for_ranges(points.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (const Index j : neighborhoods[i])
        starts[i + 1] += !listed_twice(static_cast<Index>(i), j);
  });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Vote> votes(starts.back());
  context.for_ranges(points.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::size_t at = starts[i];
      for (const Index j : neighborhoods[i]) {
        const Index self = static_cast<Index>(i);
        if (!listed_twice(self, j))
          votes[at++] = {std::min(self, j), std::max(self, j),
                         vote_of_edge(points[i], normals[i], points[j], normals[j])};
      }
    }
  });
  return votes;
}

/// Union-find that also knows whether an element is turned against the root of its set.
class SignedSets {
 public:
  explicit SignedSets(std::size_t size) : parent_(size), turned_(size, 0) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  struct Place {
    Index root;
    bool turned;
  };
  Place find(Index x) {
    bool turned = false;
    while (parent_[x] != x) {
      const Index up = parent_[x];
      turned_[x] ^= turned_[up];  // halves the path; a root is not turned
      parent_[x] = parent_[up];
      turned ^= turned_[x] != 0;
      x = parent_[x];
    }
    return {x, turned};
  }

  void merge(Index x, Index y, bool turned) {
    const Place a = find(x), b = find(y);
    if (a.root == b.root) return;
    const Index low = std::min(a.root, b.root), high = std::max(a.root, b.root);
    parent_[high] = low;
    turned_[high] = turned != (a.turned != b.turned);
  }

 private:
  std::vector<Index> parent_;
  std::vector<std::uint8_t> turned_;
};

/// The connected parts, and which of their points are turned over to agree with the rest.
struct Parts {
  std::size_t count;
  std::vector<Index> part;           // of each point
  std::vector<std::uint8_t> turned;  // each point
};

/// Borůvka's algorithm: in every round each part joins the one that it has the strongest vote
/// about. Unlike in a spanning tree of the points, where one misleading edge can turn over all that
/// hangs from it, the votes of all edges between two parts add up.
Parts join(std::size_t points, std::vector<Vote> votes, const Context& context) {
  Parts parts{points, std::vector<Index>(points), std::vector<std::uint8_t>(points, 0)};
  std::iota(parts.part.begin(), parts.part.end(), Index{0});
  while (!votes.empty()) {
    context.check();
    // Equal votes are told apart by their place, so that no cycle of equals can arise.
    std::vector<std::size_t> strongest(parts.count, votes.size());
    for (std::size_t e = 0; e < votes.size(); ++e)
      for (const Index end : {votes[e].a, votes[e].b}) {
        std::size_t& best = strongest[end];
        if (best == votes.size() || std::abs(votes[e].value) > std::abs(votes[best].value))
          best = e;
      }
    SignedSets sets(parts.count);
    for (const std::size_t e : strongest)
      if (e != votes.size()) sets.merge(votes[e].a, votes[e].b, votes[e].value < 0);

    // Number the joined parts in the order of their first ones, and carry points and votes over.
    std::vector<SignedSets::Place> place(parts.count);
    std::vector<Index> number(parts.count);
    Index count = 0;
    for (Index x = 0; x < parts.count; ++x) {
      place[x] = sets.find(x);
      number[x] = place[x].root == x ? count++ : number[place[x].root];
    }
    for (std::size_t i = 0; i < points; ++i) {
      parts.turned[i] ^= place[parts.part[i]].turned;
      parts.part[i] = number[parts.part[i]];
    }
    parts.count = count;
    std::size_t kept = 0;
    for (const Vote& vote : votes) {
      const Index a = number[vote.a], b = number[vote.b];
      if (a == b) continue;
      const bool turned = place[vote.a].turned != place[vote.b].turned;
      votes[kept++] = {std::min(a, b), std::max(a, b), turned ? -vote.value : vote.value};
    }
    votes.resize(kept);
    context.run([&] {
      // The value takes part in the order so that the sums below do not depend on the sort.
      tbb::parallel_sort(votes.begin(), votes.end(), [](const Vote& x, const Vote& y) {
        return std::tie(x.a, x.b, x.value) < std::tie(y.a, y.b, y.value);
      });
    });
    std::size_t last = 0;
    for (std::size_t e = 1; e < kept; ++e) {
      if (votes[e].a == votes[last].a && votes[e].b == votes[last].b)
        votes[last].value += votes[e].value;
      else
        votes[++last] = votes[e];
    }
    if (kept > 0) votes.resize(last + 1);
  }
  return parts;
}

/// Turns each part outwards. By the divergence theorem the integral of (p - c).n over a closed
/// surface is three times its volume; over an open one it still tells on which side of most of it
/// the centroid c lies. Unlike the normal of one extreme point, it does not hang on one estimate.
void turn_outwards(std::span<const Vec3> points, const Neighborhoods& neighborhoods,
                   const Parts& parts, std::span<Vec3> normals) {
  std::vector<Vector3d> centroid(parts.count, Vector3d::Zero());
  std::vector<double> area(parts.count, 0), volume(parts.count, 0);
  const auto area_of = [&](std::size_t i) {
    const std::span<const Index> around = neighborhoods[i];
    return around.empty() ? 1.0 : double{(points[around.back()] - points[i]).squaredNorm()};
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double a = area_of(i);
    centroid[parts.part[i]] += a * points[i].cast<double>();
    area[parts.part[i]] += a;
  }
  for (std::size_t x = 0; x < parts.count; ++x)
    if (area[x] > 0) centroid[x] /= area[x];
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d arm = points[i].cast<double>() - centroid[parts.part[i]];
    volume[parts.part[i]] += area_of(i) * arm.dot(normals[i].cast<double>());
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    if (volume[parts.part[i]] < 0) normals[i] = -normals[i];
}

}  // namespace

void orient_normals(std::span<const Vec3> points, const Neighborhoods& neighborhoods,
                    std::span<Vec3> normals, const Context& context) {
  const Parts parts =
      join(points.size(), edge_votes(points, neighborhoods, normals, context), context);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (parts.turned[i]) normals[i] = -normals[i];
  turn_outwards(points, neighborhoods, parts, normals);
}

}  // namespace meshgrain
