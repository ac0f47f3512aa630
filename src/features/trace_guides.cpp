#include "features/trace_guides.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "features/line_samples.h"
#include "measure/bvh.h"
#include "mesh/border.h"
#include "meshgrain/error.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "util/edge_of.h"

namespace meshgrain {
namespace {

using Point = Eigen::Vector3d;

// In edges of the output.
constexpr double arm = 0.25;     // over which directions are taken
constexpr double beside = 0.6;   // nearer lines count as one where they run alike
constexpr double joining = 0.4;  // ends nearer than this are led up to a line
constexpr double shortest = 0.5;
constexpr double far_off = 5;

const double cos30 = std::sqrt(0.75), cos40 = 0.766, cos45 = std::sqrt(0.5);

class Tracing {
 public:
  Tracing(const Mesh& surface, std::span<const EdgeOfLine> lines, double edge_length, double scale)
      : surface_(surface),
        edge_(edge_length),
        scale_(scale),
        tree_(surface),
        others_(beside * edge_length) {
    step_ = 0.1 * edge_;
    farthest_ = std::max(far_off * edge_, 0.05 * bounding_diagonal(surface));
    if (surface.is_point_cloud()) return;
    step_ = std::min(step_, 0.3 * edge_lengths(surface).mean);
    for (const auto& ends : rim_edges(surface)) rim_.insert(ends);
    for (const EdgeOfLine& line : lines) add_line(line.ends);
  }

  void trace(const Guide& guide, std::size_t number);

  TracedGuides result() && {
    if (parts_off_ > 0) {
      result_.notes.push_back("left out parts of " + std::to_string(parts_off_) +
                              (parts_off_ == 1 ? " guide" : " guides") +
                              ", which are far from the surface");
    }
    return std::move(result_);
  }

 private:
  struct Sample {
    Point position;
    Index face;
    double distance;        // of the guide from the surface
    bool beyond = false;    // past the border
    bool is_point = false;  // of the guide
    bool gap = false;       // whether the surface is torn before it
    Index number = 0;
    Point normal = Point::Zero();  // of the surface
    Point direction = Point::Zero();
  };

  void add_line(const std::array<Index, 2>& ends);
  Sample project(const Point& p) const;
  Point normal(Index triangle) const;
  bool is_past_border(const Point& p, const Bvh::Hit& hit) const;
  void append_segment(const Point& from, const Point& to, double step);
  void fill(const Point& from, const Point& to, const Sample& end, int depth);
  void take_samples(const std::vector<Point>& points);
  void leave_out_what_is_off(const std::string& name);
  void leave_out_what_is_beside();
  void open_where_broken();
  bool breaks(std::size_t k) const { return left_out_[k] != kept || samples_[k].gap; }
  std::array<Point, 2> arms(std::size_t k) const;
  bool is_beside_line(std::size_t k) const;
  bool is_rival(const LineSamples::Sample& other, std::size_t k) const;
  void emit(std::size_t begin, std::size_t end, float strength);
  void push_run(std::size_t begin, std::size_t end, float strength);
  void join(GuideRun& run, bool at_end, std::size_t k);

  const Mesh& surface_;
  double edge_, scale_, step_, farthest_;
  Bvh tree_;
  std::set<std::array<Index, 2>> rim_;
  LineSamples others_;
  Index lines_ = 0;  // in others_
  std::size_t parts_off_ = 0;
  TracedGuides result_;
  // Of the guide at hand:
  std::vector<Sample> samples_;
  enum LeftOut : std::uint8_t { kept, off_surface, beside_line };
  std::vector<LeftOut> left_out_;
  std::vector<double> ways_;  // of each, along the guide
  bool is_loop_ = false;
  bool closed_ = false;  // still: a loop that was broken is not
};

void Tracing::add_line(const std::array<Index, 2>& ends) {
  const Point a = surface_.positions[ends[0]].cast<double>();
  const Point d = surface_.positions[ends[1]].cast<double>() - a;
  const double count = std::ceil(d.norm() / (0.1 * edge_));
  for (double k = 0; k <= count; ++k) {
    const Point p = a + (count > 0 ? k / count : 0) * d;
    others_.add({p, d.normalized(), Point::Zero(), lines_, 0});
  }
  ++lines_;
}

Tracing::Sample Tracing::project(const Point& p) const {
  const Bvh::Hit hit = tree_.closest(p);
  Sample sample{hit.point, hit.triangle, std::sqrt(hit.squared_distance)};
  if (surface_.is_point_cloud()) {
    sample.position = p;  // points are too few to run along them
  } else {
    sample.normal = normal(hit.triangle);
    sample.beyond = is_past_border(p, hit);
  }
  return sample;
}

Point Tracing::normal(Index triangle) const {
  const auto face = surface_.faces[triangle];
  const Point a = surface_.positions[face[0]].cast<double>();
  const Point b = surface_.positions[face[1]].cast<double>() - a;
  return b.cross(surface_.positions[face[2]].cast<double>() - a).normalized();
}

bool Tracing::is_past_border(const Point& p, const Bvh::Hit& hit) const {
  const auto face = surface_.faces[hit.triangle];
  const auto corner = [&](std::size_t k) -> Point {
    return surface_.positions[face[k % 3]].cast<double>();
  };
  const Point n = normal(hit.triangle), off = p - hit.point;
  if ((off - n * n.dot(off)).norm() < 0.1 * edge_) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Index a = face[k], b = face[(k + 1) % 3];
    if (rim_.count(edge_of(a, b)) == 0) continue;
    const Point along = (corner(k + 1) - corner(k)).normalized();
    const Point to = hit.point - corner(k);
    if ((to - along * along.dot(to)).norm() < 1e-3 * edge_) return true;
  }
  return false;
}

/// Samples between that of `from`, the last one there is, and that of `to`: so many that they lie
/// close together on the surface too, which bends away from a chord.
void Tracing::fill(const Point& from, const Point& to, const Sample& end, int depth) {
  const bool is_dense = (end.position - samples_.back().position).norm() < 2 * step_;
  if (is_dense || depth == 0) {
    samples_.push_back(end);
    samples_.back().gap = !is_dense;
    return;
  }
  const Point middle = 0.5 * (from + to);
  fill(from, middle, project(middle), depth - 1);
  fill(middle, to, end, depth - 1);
}

void Tracing::append_segment(const Point& from, const Point& to, double step) {
  const double count = std::max(1.0, std::ceil((to - from).norm() / step));
  Point before = from;
  for (double k = 1; k <= count; ++k) {
    const Point p = k == count ? to : Point(from + (k / count) * (to - from));
    constexpr int depth = 6;
    fill(before, p, project(p), depth);
    before = p;
  }
  samples_.back().is_point = true;
}

/// How the guide comes to sample k, and how it goes on, over an arm's length each.
std::array<Point, 2> Tracing::arms(std::size_t k) const {
  const std::size_t n = samples_.size();
  const auto follow = [&](bool ahead) -> Point {
    std::size_t at = k;
    double way = 0;
    while (way < arm * edge_) {
      std::size_t next = at;
      if (ahead) {
        next = at + 1 < n ? at + 1 : closed_ ? 1 : n;
      } else {
        next = at > 0 ? at - 1 : closed_ ? n - 2 : n;
      }
      if (next >= n || next == k || samples_[ahead ? next : at].gap) break;
      way += (samples_[next].position - samples_[at].position).norm();
      at = next;
    }
    return samples_[at].position;
  };
  const Point& p = samples_[k].position;
  return {p - follow(false), follow(true) - p};
}

/// Whether another line passes there: on this side of a thin wall, and not only the guide itself.
bool Tracing::is_rival(const LineSamples::Sample& other, std::size_t k) const {
  if (other.normal.dot(samples_[k].normal) < 0) return false;
  if (other.line != lines_) return true;
  const double between = std::abs(ways_[samples_[k].number] - ways_[other.number]);
  const double around = is_loop_ ? ways_.back() - between : between;
  return std::min(between, around) > 2.5 * edge_;
}

bool Tracing::is_beside_line(std::size_t k) const {
  const Sample& s = samples_[k];
  bool found = false;
  others_.for_near(s.position, beside * edge_, [&](const LineSamples::Sample& other, double) {
    found = found || (is_rival(other, k) && std::abs(other.direction.dot(s.direction)) > cos30);
  });
  return found;
}

void Tracing::trace(const Guide& guide, std::size_t number) {
  const std::string name = "guide " + std::to_string(number + 1);
  if (!(guide.strength >= 0 && guide.strength <= 1)) {
    throw Error(name + ": the strength must lie between 0 and 1");
  }
  std::vector<Point> points;
  for (const Point& p : guide.points) {
    if (!p.allFinite()) throw Error(name + " has a point that is not finite");
    if (points.empty() || p != points.back()) points.push_back(p);
  }
  closed_ = is_loop_ = points.size() > 2 && (guide.closed || points.front() == points.back());
  if (closed_ && points.front() != points.back()) points.push_back(Point(points.front()));
  if (points.size() < 2) throw Error(name + " has fewer than two points");

  take_samples(points);
  leave_out_what_is_off(name);
  if (guide.strength == 1 && !surface_.is_point_cloud()) leave_out_what_is_beside();
  if (closed_) open_where_broken();
  if (closed_) {
    emit(0, samples_.size(), guide.strength);
  } else {
    for (std::size_t k = 0; k < samples_.size();) {
      std::size_t end = k + (left_out_[k] == kept);
      while (end > k && end < samples_.size() && !breaks(end)) ++end;
      if (end > k) emit(k, end, guide.strength);
      k = std::max(end, k + 1);
    }
  }
  ++lines_;
}

void Tracing::take_samples(const std::vector<Point>& points) {
  double length = 0;
  for (std::size_t k = 1; k < points.size(); ++k) length += (points[k] - points[k - 1]).norm();
  constexpr double most = 1e6;  // samples
  const double step = std::max(step_, length / most);
  samples_.assign(1, project(points[0]));
  samples_[0].is_point = true;
  for (std::size_t k = 1; k < points.size(); ++k) append_segment(points[k - 1], points[k], step);
  ways_.assign(samples_.size(), 0);
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    samples_[k].number = static_cast<Index>(k);
    if (k > 0) ways_[k] = ways_[k - 1] + (samples_[k].position - samples_[k - 1].position).norm();
    const auto [in, out] = arms(k);
    samples_[k].direction = (in.normalized() + out.normalized()).normalized();
  }
}

void Tracing::leave_out_what_is_off(const std::string& name) {
  double nearest = std::numeric_limits<double>::infinity();
  bool any = false, far = false;
  left_out_.clear();
  for (const Sample& s : samples_) {
    nearest = std::min(nearest, s.distance);
    const bool is_far = s.distance > farthest_;
    left_out_.push_back(s.beyond || is_far ? off_surface : kept);
    any = any || left_out_.back() == kept;
    far = far || (is_far && !s.beyond);
  }
  if (!any) {
    throw Error(name + " lies off the surface, " + std::to_string(nearest * scale_) +
                " away from it where it is nearest: its points must be in the place and the units "
                "of the input");
  }
  parts_off_ += far;
}

void Tracing::leave_out_what_is_beside() {
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    if (left_out_[k] == kept && is_beside_line(k)) left_out_[k] = beside_line;
    if (left_out_[k] != kept) continue;
    const Sample& at = samples_[k];
    others_.add({at.position, at.direction, at.normal, lines_, at.number});
  }
}

/// Makes a loop begin where it is broken, if it is.
void Tracing::open_where_broken() {
  std::size_t first = 0;
  while (first < samples_.size() && !breaks(first)) ++first;
  if (first == samples_.size()) return;
  samples_.pop_back();
  left_out_.pop_back();
  const auto turn = static_cast<std::ptrdiff_t>(first % samples_.size());
  std::rotate(samples_.begin(), samples_.begin() + turn, samples_.end());
  std::rotate(left_out_.begin(), left_out_.begin() + turn, left_out_.end());
  closed_ = false;
}

/// The samples from `begin` to `end`, broken at the guide's corners.
void Tracing::emit(std::size_t begin, std::size_t end, float strength) {
  double length = 0;
  for (std::size_t k = begin + 1; k < end; ++k) {
    length += (samples_[k].position - samples_[k - 1].position).norm();
  }
  if (length < shortest * edge_) return;
  std::vector<std::size_t> corners;
  for (std::size_t k = begin + !closed_; k + 1 < end; ++k) {
    if (!samples_[k].is_point) continue;
    const auto [in, out] = arms(k);
    if (in.dot(out) < cos40 * in.norm() * out.norm()) corners.push_back(k);
  }
  const bool whole = closed_;
  if (closed_ && !corners.empty()) {  // from corner to corner
    samples_.pop_back();
    const auto turn = static_cast<std::ptrdiff_t>(corners[0]);
    std::rotate(samples_.begin(), samples_.begin() + turn, samples_.end());
    samples_.push_back(Sample(samples_.front()));
    for (std::size_t& c : corners) c -= static_cast<std::size_t>(turn);
    corners.erase(corners.begin());
    closed_ = false;
    left_out_.assign(samples_.size(), kept);
  }
  const std::size_t first = begin;
  corners.push_back(end - 1);
  for (const std::size_t corner : corners) {
    push_run(begin, corner + 1, strength);
    if (begin == first && !whole) join(result_.runs.back(), false, begin);
    if (corner == end - 1 && !whole) join(result_.runs.back(), true, corner);
    begin = corner;
  }
}

void Tracing::push_run(std::size_t begin, std::size_t end, float strength) {
  GuideRun run;
  // A loop may have one corner.
  run.closed = samples_[begin].position == samples_[end - 1].position && end - begin > 2;
  run.strength = strength;
  for (std::size_t k = begin; k < end; ++k) {
    const Sample& s = samples_[k];
    run.points.push_back({s.position, s.direction, s.face});
  }
  if (!closed_) {  // directions do not turn around corners
    run.points.front().direction = arms(begin)[1].normalized();
    run.points.back().direction = arms(end - 1)[0].normalized();
  }
  result_.runs.push_back(std::move(run));
}

/// Leads an end up to a line close by; one that was cut off beside that line only if the line lies
/// ahead.
void Tracing::join(GuideRun& run, bool at_end, std::size_t k) {
  if (run.strength < 1 || surface_.is_point_cloud()) return;
  const std::size_t next = at_end ? k + 1 : k - 1;  // beyond all if there is none
  const bool was_beside = next < left_out_.size() && left_out_[next] == beside_line;
  const GuideRun::Point end = at_end ? run.points.back() : run.points.front();
  const Point outwards = at_end ? end.direction : Point(-end.direction);
  double least = std::numeric_limits<double>::infinity();
  Point best = end.position;
  others_.for_near(
      end.position, beside * edge_, [&](const LineSamples::Sample& other, double distance) {
        if (distance >= least || !is_rival(other, k)) return;
        const double ahead = (other.position - end.position).dot(outwards);
        const bool reached = was_beside ? ahead > cos45 * distance : distance < joining * edge_;
        if (!reached) return;
        least = distance;
        best = other.position;
      });
  if (!std::isfinite(least)) return;
  const Bvh::Hit hit = tree_.closest(best);
  const GuideRun::Point joined{hit.point, end.direction, hit.triangle};
  run.points.insert(at_end ? run.points.end() : run.points.begin(), joined);
}

}  // namespace

TracedGuides trace_guides(const Mesh& surface, std::span<const Guide> guides,
                          std::span<const EdgeOfLine> lines, double edge_length, double scale) {
  Tracing tracing(surface, lines, edge_length, scale);
  for (std::size_t k = 0; k < guides.size(); ++k) tracing.trace(guides[k], k);
  return std::move(tracing).result();
}

}  // namespace meshgrain
