#include "symmetry/fold_guides.h"

#include <algorithm>
#include <utility>

namespace meshgrain {
namespace {

using Point = Eigen::Vector3d;

class Folding {
 public:
  Folding(const MirrorPlane& plane, std::vector<Guide>& out)
      : axis_(plane.axis), offset_(plane.offset), out_(out) {}

  void fold(const Guide& guide) {
    if (guide.points.empty()) return;
    std::vector<Point> points = with_crossings(guide);
    if (guide.closed) {
      // Open at the first crossing, if there is any.
      std::size_t k = 0;
      while (k < points.size() && !crosses(points, k, true)) ++k;
      if (k == points.size()) {
        Guide whole = guide;
        for (Point& p : whole.points) p = above(p);
        out_.push_back(std::move(whole));
        return;
      }
      std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(k), points.end());
      points.push_back(points[0]);
    }
    Guide part{{}, false, guide.strength};
    const auto finish = [&] {
      if (part.points.size() > 1) out_.push_back(part);
      part.points.clear();
    };
    for (std::size_t k = 0; k < points.size(); ++k) {
      part.points.push_back(above(points[k]));
      if (!crosses(points, k, false)) continue;
      finish();
      part.points.push_back(above(points[k]));
    }
    finish();
  }

 private:
  double side(const Point& p) const { return p[axis_] - offset_; }

  /// Its points, and others in the plane wherever it goes from one side to the other between two.
  std::vector<Point> with_crossings(const Guide& guide) const {
    const std::size_t count = guide.points.size();
    std::vector<Point> result;
    for (std::size_t k = 0; k < count; ++k) {
      const Point &here = guide.points[k], &next = guide.points[(k + 1) % count];
      result.push_back(here);
      if (k + 1 == count && !guide.closed) break;
      if (side(here) * side(next) < 0) result.push_back(crossing(here, next));
    }
    return result;
  }

  /// Whether a point is in the plane, and the first ones before and after it that are not lie on
  /// different sides; of several in a row, the last one is.
  bool crosses(const std::vector<Point>& points, std::size_t k, bool around) const {
    const std::size_t count = points.size();
    if (side(points[k]) != 0 || (!around && k + 1 == count)) return false;
    const double after = side(points[(k + 1) % count]);
    if (after == 0) return false;
    for (std::size_t n = 1, i = k; n < count && (around || i > 0); ++n) {
      i = (i + count - 1) % count;
      if (const double before = side(points[i]); before != 0) return before * after < 0;
    }
    return false;
  }

  Point above(Point p) const {
    p[axis_] = offset_ + std::abs(side(p));
    return p;
  }

  Point crossing(const Point& a, const Point& b) const {
    Point p = a + side(a) / (side(a) - side(b)) * (b - a);
    p[axis_] = offset_;
    return p;
  }

  int axis_;
  double offset_;
  std::vector<Guide>& out_;
};

}  // namespace

std::vector<Guide> fold_guides(const std::vector<Guide>& guides, const MirrorPlane& plane) {
  std::vector<Guide> result;
  Folding folding(plane, result);
  for (const Guide& guide : guides) folding.fold(guide);
  return result;
}

}  // namespace meshgrain
