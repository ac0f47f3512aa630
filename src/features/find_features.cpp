#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/border.h"
#include "meshgrain/features.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

using Edge = std::array<Index, 2>;

/// The creases of a mechanical part; nothing for a sculpture or a scan, whose sharp edges are
/// detail or noise. Told by the length of edges of every sharpness: in a part they are either
/// nearly flat or creases, with little in between.
std::vector<Edge> mechanical_creases(const Mesh& mesh, const Context& context) {
  constexpr double sharp = 40, flat = 10;  // degrees
  const std::vector<SharpEdge> edges = sharp_edges(mesh, flat, context);
  const auto is_above = [](const SharpEdge& edge, double degrees) {
    return edge.cosine < std::cos(degrees * std::numbers::pi / 180);
  };
  const auto length_above = [&](double degrees) {
    double sum = 0;
    for (const SharpEdge& edge : edges) {
      const auto [a, b] = edge.ends;
      if (is_above(edge, degrees)) sum += (mesh.positions[a] - mesh.positions[b]).norm();
    }
    return sum;
  };
  const double creases = length_above(sharp);
  if (creases <= length_above(flat) - creases) return {};
  // The threshold is where it matters least.
  double threshold = sharp, least = std::numeric_limits<double>::infinity();
  constexpr double lowest = 20, window = 1.25, step = 2;
  for (double degrees = sharp; degrees >= lowest; degrees -= step) {
    const double doubtful = length_above(degrees / window) - length_above(degrees * window);
    if (doubtful >= least) continue;
    least = doubtful;
    threshold = degrees;
  }
  std::vector<Edge> result;
  for (const SharpEdge& edge : edges) {
    if (is_above(edge, threshold)) result.push_back(edge.ends);
  }
  return result;
}

/// Joins edges to lines that end at corners.
class Chaining {
 public:
  Chaining(const Mesh& mesh, const std::vector<Edge>& border, const std::vector<Edge>& creases,
           double edge_length)
      : mesh_(mesh), arm_(edge_length), offsets_(mesh.positions.size() + 1, 0) {
    for (const auto& list : {border, creases}) {
      for (const auto& [a, b] : list) {
        ++offsets_[a + 1];
        ++offsets_[b + 1];
      }
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) offsets_[v + 1] += offsets_[v];
    spokes_.resize(offsets_.back());
    std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
    for (const auto* list : {&border, &creases}) {
      for (const auto& [a, b] : *list) {
        spokes_[next[a]++] = {b, list == &border, false};
        spokes_[next[b]++] = {a, list == &border, false};
      }
    }
    corner_.assign(mesh.positions.size(), 0);
  }

  FeatureLines run(const FeatureOptions& options) {
    const auto count = static_cast<Index>(mesh_.positions.size());
    for (Index v = 0; v < count; ++v) corner_[v] = degree(v) != 0 && !goes_on(v);
    for (Index v = 0; v < count; ++v) {
      if (degree(v) == 2 && !corner_[v]) corner_[v] = turns(v) ? 1 : 0;
    }
    std::vector<std::uint8_t> ragged(count, 0);
    for (Index v = 0; v < count; ++v) ragged[v] = corner_[v] && is_beside_sharper(v);
    for (Index v = 0; v < count; ++v) corner_[v] -= ragged[v];
    FeatureLines lines;
    const auto follow_lines = [&](Index v) {
      for (Index s = offsets_[v]; s < offsets_[v + 1]; ++s) {
        if (spokes_[s].done) continue;
        const bool is_border = spokes_[s].border;
        walk(v, s, lines.vertices);
        lines.starts.push_back(static_cast<Index>(lines.vertices.size()));
        // Softly: a ragged border turns faster than crosses can.
        constexpr float orient_border = 0.45f;
        const bool follow = !is_border || options.align_border;
        lines.orient.push_back(!follow ? 0 : is_border ? orient_border : options.orient_creases);
        lines.align.push_back(!follow ? 0 : is_border ? 1 : options.align_creases);
      }
    };
    for (Index v = 0; v < count; ++v) {
      if (!corner_[v]) continue;
      lines.corners.push_back(v);
      follow_lines(v);
    }
    for (Index v = 0; v < count; ++v) follow_lines(v);  // what is closed
    for (const Index v : lines.vertices) lines.positions.push_back(mesh_.positions[v]);
    return lines;
  }

 private:
  struct Spoke {
    Index to;
    bool border, done;
  };

  Index degree(Index v) const { return offsets_[v + 1] - offsets_[v]; }

  /// Whether one line goes through a vertex.
  bool goes_on(Index v) const {
    return degree(v) == 2 && spokes_[offsets_[v]].border == spokes_[offsets_[v] + 1].border;
  }

  /// The spoke that goes on from v, for who came from `from`.
  Index onward(Index v, Index from) const {
    return spokes_[offsets_[v]].to == from ? offsets_[v] + 1 : offsets_[v];
  }

  /// The point of the line at an arm's length from v, starting along a spoke.
  Vec3 at_arms_length(Index v, Index spoke) const {
    double left = arm_;
    Index from = v, to = spokes_[spoke].to;
    for (;;) {
      const Vec3 &p = mesh_.positions[from], &q = mesh_.positions[to];
      const double length = (q - p).norm();
      if (length >= left) return p + static_cast<float>(left / length) * (q - p);
      left -= length;
      if (!goes_on(to) || to == v) return q;
      const Index next = spokes_[onward(to, from)].to;
      from = to;
      to = next;
    }
  }

  bool turns(Index v) const {
    const auto is_sharp = [&](const Vec3& back, const Vec3& ahead) {
      const Vec3 in = mesh_.positions[v] - back, out = ahead - mesh_.positions[v];
      constexpr float cos40 = 0.766f;
      return in.dot(out) < cos40 * in.norm() * out.norm();
    };
    const Index first = offsets_[v], second = first + 1;
    return is_sharp(mesh_.positions[spokes_[first].to], mesh_.positions[spokes_[second].to]) &&
           (arm_ == 0 || is_sharp(at_arms_length(v, first), at_arms_length(v, second)));
  }

  /// The cosine of the turn at v, over an arm's length.
  float straightness(Index v) const {
    const Vec3 in = mesh_.positions[v] - at_arms_length(v, offsets_[v]);
    const Vec3 out = at_arms_length(v, offsets_[v] + 1) - mesh_.positions[v];
    return in.dot(out) / (in.norm() * out.norm());
  }

  /// Scans have ragged borders, that turn sharply again and again: whether v is a corner of one
  /// that is less sharp than the next.
  bool is_beside_sharper(Index v) const {
    if (!goes_on(v) || !spokes_[offsets_[v]].border) return false;
    const std::pair own(straightness(v), v);
    for (Index spoke = offsets_[v]; spoke < offsets_[v + 1]; ++spoke) {
      Index from = v, to = spokes_[spoke].to;
      double way = (mesh_.positions[to] - mesh_.positions[v]).norm();
      while (way < arm_ && goes_on(to) && to != v) {
        if (corner_[to] && std::pair(straightness(to), to) < own) return true;
        const Index next = spokes_[onward(to, from)].to;
        way += (mesh_.positions[next] - mesh_.positions[to]).norm();
        from = to;
        to = next;
      }
    }
    return false;
  }

  void walk(Index v, Index spoke, std::vector<Index>& out) {
    out.push_back(v);
    for (Index at = v;;) {
      const Index to = spokes_[spoke].to;
      spokes_[spoke].done = true;
      for (Index s = offsets_[to]; s < offsets_[to + 1]; ++s) {
        if (spokes_[s].to == at) spokes_[s].done = true;
      }
      out.push_back(to);
      if (to == v || corner_[to]) return;
      spoke = onward(to, at);
      at = to;
    }
  }

  const Mesh& mesh_;
  double arm_;
  std::vector<Index> offsets_;
  std::vector<Spoke> spokes_;
  std::vector<std::uint8_t> corner_;
};

}  // namespace

bool FeatureLines::is_closed(std::size_t line) const {
  const Index v = vertices[begin(line)];
  return v == vertices[end(line) - 1] && !std::binary_search(corners.begin(), corners.end(), v);
}

FeatureLines find_features(const Mesh& mesh, const FeatureOptions& options, double edge_length,
                           const Context& context) {
  const std::vector<Edge> border = rim_edges(mesh, context);
  std::vector<Edge> creases;
  if (options.creases == Creases::automatic) creases = mechanical_creases(mesh, context);
  if (options.creases == Creases::by_angle) {
    creases = crease_edges(mesh, options.crease_degrees, context);
  }
  return Chaining(mesh, border, creases, edge_length).run(options);
}

}  // namespace meshgrain
