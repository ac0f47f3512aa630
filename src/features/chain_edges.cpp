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
      return own == LineKind::marked ? LineKind::crease : own;
    };
    return degree(v) == 2 && kind(offsets_[v]) == kind(offsets_[v] + 1);
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
