#include "cloud/nearest_neighbors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>

#include "mesh/duplicates.h"

namespace meshgrain {
namespace {

/// What nanoflann asks of a set of points.
struct Points {
  std::span<const Vec3> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                 Points, 3, Index>;

/// The best k so far, sorted by distance and then index. nanoflann's own result set keeps whichever
/// of two equally distant points it meets first, which depends on the tree.
class Nearest {
 public:
  using DistanceType = float;

  explicit Nearest(std::size_t k) : found_(k) {}

  void start(Index self) {
    self_ = self;
    size_ = 0;
    bound_ = std::numeric_limits<float>::max();
  }

  bool addPoint(float distance, Index index) {
    const Candidate candidate{distance, index};
    if (index == self_ || (full() && !(candidate < found_.back()))) return true;
    std::size_t i = full() ? size_ - 1 : size_++;
    for (; i > 0 && candidate < found_[i - 1]; --i) found_[i] = found_[i - 1];
    found_[i] = candidate;
    // The search offers what is nearer than this, and ties shall be offered as well.
    if (full())
      bound_ = std::nextafter(found_.back().distance, std::numeric_limits<float>::infinity());
    return true;
  }

  float worstDist() const { return bound_; }
  void sort() {}  // which versions from 1.6 on ask for
  bool full() const { return size_ == found_.size(); }
  std::size_t size() const { return size_; }
  Index operator[](std::size_t i) const { return found_[i].index; }

 private:
  struct Candidate {
    float distance;
    Index index;
    bool operator<(const Candidate& other) const {
      return distance < other.distance || (distance == other.distance && index < other.index);
    }
  };
  std::vector<Candidate> found_;
  std::size_t size_ = 0;
  float bound_ = 0;
  Index self_ = no_index;
};

}  // namespace

Neighborhoods nearest_neighbors(std::span<const Vec3> points, std::size_t k,
                                const Context& context) {
  Neighborhoods result{k, std::vector<Index>(points.size() * k, no_index)};
  if (k == 0 || points.empty()) return result;

  // A tree of the distinct positions: a heap of equal points would make every query among them
  // visit all of them.
  std::vector<Index> place;
  const std::vector<Index> distinct = distinct_positions(points, &place, context);
  std::vector<Vec3> copies;
  Points source{points};
  if (distinct.size() < points.size()) {
    copies.reserve(distinct.size());
    for (const Index i : distinct) copies.push_back(points[i]);
    source.points = copies;
  }
  const Tree tree(3, source, nanoflann::KDTreeSingleIndexAdaptorParams(10));

  context.for_ranges(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    context.check();
    Nearest nearest(k);
    for (std::size_t i = begin; i < end; ++i) {
      nearest.start(place[i]);
      tree.findNeighbors(nearest, points[i].data(), {});
      for (std::size_t n = 0; n < nearest.size(); ++n)
        result.indices[i * k + n] = distinct[nearest[n]];
    }
  });
  return result;
}

void leave_out_other_sides(Neighborhoods& nearest, std::span<const Vec3> normals,
                           const Context& context) {
  constexpr float other_way = -0.5f;
  context.for_ranges(normals.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::span<Index> all(nearest.indices.data() + i * nearest.k, nearest.k);
      const auto left = std::ranges::remove_if(
          all, [&](Index j) { return j == no_index || normals[i].dot(normals[j]) < other_way; });
      std::ranges::fill(left, no_index);
    }
  });
}

std::vector<Index> nearest_points(std::span<const Vec3> points, std::span<const Vec3> queries,
                                  const Context& context) {
  const Points set{points};
  const Tree tree(3, set);
  std::vector<Index> result(queries.size());
  context.for_ranges(queries.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      float distance = 0;
      tree.knnSearch(queries[i].data(), 1, &result[i], &distance);
    }
  });
  return result;
}

}  // namespace meshgrain
