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
    std::vector<Point> points = guide.points;
    const auto crossed = [&](std::size_t k) {
      return side(points[k]) * side(points[(k + 1) % points.size()]) < 0;
    };
    if (guide.closed && !points.empty()) {
      // Open at the first crossing, if there is any.
      std::size_t k = 0;
      while (k < points.size() && !crossed(k)) ++k;
      if (k == points.size()) {
        Guide whole = guide;
        for (Point& p : whole.points) p = above(p);
        out_.push_back(std::move(whole));
        return;
      }
      const Point start = crossing(points[k], points[(k + 1) % points.size()]);
      std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(k) + 1,
                  points.end());
      points.insert(points.begin(), start);
      points.push_back(start);
    }
    Guide part{{}, false, guide.strength};
    const auto finish = [&] {
      if (part.points.size() > 1) out_.push_back(part);
      part.points.clear();
    };
    for (std::size_t k = 0; k < points.size(); ++k) {
      part.points.push_back(above(points[k]));
      if (k + 1 == points.size() || !crossed(k)) continue;
      const Point p = crossing(points[k], points[k + 1]);
      part.points.push_back(p);
      finish();
      part.points.push_back(p);
    }
    finish();
  }

 private:
  double side(const Point& p) const { return p[axis_] - offset_; }

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
