#include "features/chain_edges.h"

#include <array>
#include <utility>

namespace meshgrain {
namespace {

/// How strongly orientations and positions are held to a line.
std::array<float, 2> strengths(LineKind kind, const FeatureOptions& options) {
  if (kind == LineKind::guide) return {0, 1};  // their directions are their own
  if (kind != LineKind::border) return {options.orient_creases, options.align_creases};
  // Softly: a ragged border turns faster than crosses can.
  constexpr float orient_border = 0.45f;
  return options.align_border ? std::array{orient_border, 1.0f} : std::array{0.0f, 0.0f};
}

class Chaining {
 public:
  Chaining(const Mesh& mesh, const std::vector<EdgeOfLine>& edges, double edge_length)
      : mesh_(mesh), arm_(edge_length), offsets_(mesh.positions.size() + 1, 0) {
    for (const auto& [ends, kind] : edges) {
      for (const Index v : ends) ++offsets_[v + 1];
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) offsets_[v + 1] += offsets_[v];
    spokes_.resize(offsets_.back());
    std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
    for (const auto& [ends, kind] : edges) {
      const auto [a, b] = ends;
      spokes_[next[a]++] = {b, kind, false};
      spokes_[next[b]++] = {a, kind, false};
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
        const LineKind kind = spokes_[s].kind;
        walk(v, s, lines.vertices);
        lines.starts.push_back(static_cast<Index>(lines.vertices.size()));
        const auto [orient, align] = strengths(kind, options);
        lines.orient.push_back(orient);
        lines.align.push_back(align);
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
    LineKind kind;
    bool done;
  };

  Index degree(Index v) const { return offsets_[v + 1] - offsets_[v]; }

  /// Whether one line goes through a vertex. Creases go on as marked edges: a crease may flatten
  /// out.
  bool goes_on(Index v) const {
    const auto kind = [&](Index spoke) {
      const LineKind own = spokes_[spoke].kind;
      return own == LineKind::marked || own == LineKind::drawn ? LineKind::crease : own;
    };
    return degree(v) == 2 && kind(offsets_[v]) == kind(offsets_[v] + 1);
  }

  /// The spoke that goes on from v, for who came from `from`.
  Index onward(Index v, Index from) const {
    return spokes_[offsets_[v]].to == from ? offsets_[v] + 1 : offsets_[v];
  }

  /// How far a line goes, and what of a length that was asked for is missing.
  struct Reach {
    Vec3 end;
    double missing;
  };

  /// Calls `visit(p, q)` for each piece of the line within a length of v, starting along a spoke.
  template <typename Visit>
  Reach follow(Index v, Index spoke, double length, const Visit& visit) const {
    double left = length;
    Index from = v, to = spokes_[spoke].to;
    for (;;) {
      const Vec3 &p = mesh_.positions[from], &q = mesh_.positions[to];
      const double edge = (q - p).norm();
      if (edge >= left) {
        const Vec3 end = p + static_cast<float>(left / edge) * (q - p);
        visit(p, end);
        return {end, 0};
      }
      visit(p, q);
      left -= edge;
      if (!goes_on(to) || to == v) return {q, left};
      const Index next = spokes_[onward(to, from)].to;
      from = to;
      to = next;
    }
  }

  /// The point of the line at an arm's length from v, starting along a spoke.
  Vec3 at_arms_length(Index v, Index spoke) const {
    return follow(v, spoke, arm_, [](const Vec3&, const Vec3&) {}).end;
  }

  /// The mean of the line from v on for a length, starting along a spoke.
  Vec3 mean(Index v, Index spoke, double length) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const Reach reach = follow(v, spoke, length, [&](const Vec3& p, const Vec3& q) {
      sum += ((q - p).norm() / 2 * (p + q)).cast<double>();
    });
    return ((sum + reach.missing * reach.end.cast<double>()) / length).cast<float>();
  }

  bool turns(Index v) const {
    const Index back = offsets_[v], ahead = back + 1;
    const Vec3& p = mesh_.positions[v];
    const auto is_sharp = [&](const Vec3& from, const Vec3& to) {
      return is_sharp_turn(p - from, to - p);
    };
    if (!is_sharp(mesh_.positions[spokes_[back].to], mesh_.positions[spokes_[ahead].to])) {
      return false;
    }
    if (arm_ == 0) return true;
    if (is_ragged(v)) return turns_in_the_mean(v);
    return is_sharp(at_arms_length(v, back), at_arms_length(v, ahead));
  }

  /// Whether a line that was drawn on the surface turns sharply at other vertices, too, less than
  /// an arm's length from v.
  bool is_ragged(Index v) const {
    for (Index spoke = offsets_[v]; spoke < offsets_[v + 1]; ++spoke) {
      if (spokes_[spoke].kind != LineKind::drawn) return false;
    }
    bool any = false;
    for (Index spoke = offsets_[v]; spoke < offsets_[v + 1]; ++spoke) {
      Vec3 before = Vec3::Zero();
      double way = 0;
      follow(v, spoke, arm_, [&](const Vec3& p, const Vec3& q) {
        any = any || (way > 0 && is_sharp_turn(before, q - p));
        before = q - p;
        way += before.norm();
      });
    }
    return any;
  }

  /// Where materials meet, or parts of a scan, the line between them is mostly ragged, along the
  /// sides of triangles. Whether it turns by 60 degrees or more once each of its points is the mean
  /// of an arm's length to both sides. Less counts where lines are not ragged; of these, in 85
  /// meshes of quads, it would cost shape and irregular vertices.
  bool turns_in_the_mean(Index v) const {
    constexpr float cos32 = 0.848f;  // what is left of 60 degrees
    const Index back = offsets_[v], ahead = back + 1;
    const Vec3 here = (mean(v, back, arm_) + mean(v, ahead, arm_)) / 2;
    return is_sharp_turn(here - mean(v, back, 2 * arm_), mean(v, ahead, 2 * arm_) - here, cos32);
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
    if (!goes_on(v) || spokes_[offsets_[v]].kind != LineKind::border) return false;
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

FeatureLines chain_edges(const Mesh& mesh, const std::vector<EdgeOfLine>& edges,
                         const FeatureOptions& options, double edge_length) {
  return Chaining(mesh, edges, edge_length).run(options);
}

}  // namespace meshgrain
