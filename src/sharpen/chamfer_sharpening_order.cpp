// Along creases made sharp again and beside them, vertices and edges come in no order at first.

#include <algorithm>
#include <ranges>
#include <utility>

#include "sharpen/chamfer_sharpening.h"
#include "sharpen/meet.h"
#include "util/edge_of.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

using Point = ChamferSharpening::Point;

constexpr std::size_t grain = 512;

}  // namespace

/// Vertices along creases, where they may have come out of order, and those beside them that have
/// been moved: first all, then those around which there still are folds.
void ChamferSharpening::space_out() {
  constexpr int rounds = 5, most = 6;
  find_neighbours_on_crease();
  std::vector<Index> moving;
  for (Index v = 0; v < mesh_.positions.size(); ++v) {
    if (may_slide(v)) moving.push_back(v);
  }
  for (int k = 0; k < most && !moving.empty(); ++k) {
    for (int round = 0; round < rounds; ++round) slide(moving);
    turn_edges();
    moving = near_folds();
  }
}

void ChamferSharpening::find_neighbours_on_crease() {
  on_crease_beside_.assign(mesh_.positions.size(), {});
  for (const auto& [a, b] : creases()) {
    on_crease_beside_[a].push_back(b);
    on_crease_beside_[b].push_back(a);
  }
}

bool ChamferSharpening::may_slide(Index v) const {
  if (stays_[v]) return false;
  if (is_on_[v]) return on_crease_beside_[v].size() == 2;
  return chamfers_.has_part(v) && !chamfers_.is_smooth(v);
}

/// Half the way to between their neighbours, along what they lie on.
void ChamferSharpening::slide(std::span<const Index> moving) {
  const auto between = [&](Index v) -> Point {
    return (place(on_crease_beside_[v][0]) + place(on_crease_beside_[v][1])) / 2;
  };
  const auto middle_around = [&](Index v) -> Point {
    Point sum = Point::Zero();
    for (const Index f : around_[v]) {
      for (const Index w : std::as_const(mesh_.faces)[f]) sum += place(w) - place(v);
    }
    return place(v) + sum / (2. * static_cast<double>(around_[v].size()));
  };
  std::vector<Vec3> places(moving.size());
  context_.for_ranges(moving.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Index v = moving[k];
      const Point from = place(v);
      const Point to = is_on_[v]
                           ? meet((from + between(v)) / 2, parts_around(v))
                           : meet((from + middle_around(v)) / 2, std::array{chamfers_.plane(v)});
      places[k] = (to - from).norm() < chamfers_.edge() ? to.cast<float>() : mesh_.positions[v];
    }
  });
  for (std::size_t k = 0; k < moving.size(); ++k) mesh_.positions[moving[k]] = places[k];
}

/// Vertices that may slide, up to so many edges from where a crease goes back over itself, or a
/// face looks away from its part.
std::vector<Index> ChamferSharpening::near_folds() const {
  constexpr int reach = 5;
  std::vector<Index> result;
  for (Index v = 0; v < mesh_.positions.size(); ++v) {
    if (!is_on_[v] || !may_slide(v)) continue;
    const Point p = place(v), a = place(on_crease_beside_[v][0]),
                b = place(on_crease_beside_[v][1]);
    if ((a - p).dot(b - p) > 0) result.push_back(v);
  }
  for (Index f = 0; f < mesh_.faces.size(); ++f) {
    if (!is_folded(f)) continue;
    const Corners corners = corners_of(f);
    result.insert(result.end(), corners.begin(), corners.end());
  }
  grow(result, reach);
  std::erase_if(result, [&](Index v) { return !may_slide(v); });
  return result;
}

/// By all that are so many edges away.
void ChamferSharpening::grow(std::vector<Index>& vertices, int reach) const {
  for (int k = 0; k < reach; ++k) {
    for (std::size_t i = vertices.size(); i-- > 0;) {
      for (const Index f : around_[vertices[i]]) {
        const Corners corners = corners_of(f);
        vertices.insert(vertices.end(), corners.begin(), corners.end());
      }
    }
    sort_unique(vertices);
  }
}

/// Edges inside of a part to the other diagonal, beside faces that look away from it: what was one
/// beside a corner before can lie on both sides of it now.
void ChamferSharpening::turn_edges() {
  constexpr int most = 4;
  for (int k = 0; k < most && turn_edges_apart(); ++k) around_ = vertex_faces(mesh_, context_);
}

/// Those that have nothing to do with each other.
bool ChamferSharpening::turn_edges_apart() {
  const std::size_t before = turns_.size();
  std::vector<std::uint8_t> is_taken(mesh_.positions.size(), 0);
  for (Index f = 0; f < mesh_.faces.size(); ++f) {
    if (!is_folded(f)) continue;
    for (std::size_t k = 0; k < 3 && !turn(f, k, is_taken); ++k) {
    }
  }
  return turns_.size() > before;
}

/// The edge opposite to a corner, if both faces beside it are the better for it.
bool ChamferSharpening::turn(Index f, std::size_t k, std::vector<std::uint8_t>& is_taken) {
  const Corners t = corners_of(f);
  const Index apex = t[k], a = t[(k + 1) % 3], b = t[(k + 2) % 3];
  const auto are_beside = [&](Index v, Index w) {
    return std::ranges::any_of(around_[v],
                               [&](Index g) { return corner_of(corners_of(g), w) < 3; });
  };
  const auto is_beyond = [&](Index g) { return g != f && corner_of(corners_of(g), b) < 3; };
  const auto found = std::ranges::find_if(around_[a], is_beyond);
  if (found == around_[a].end()) return false;
  const Index g = *found;
  if (part_of_[g] == no_index || chamfers_.meet_in_crease(part_of_[f], part_of_[g])) return false;
  const Corners u = corners_of(g);
  const std::size_t at_b = corner_of(u, b);
  const Index beyond = u[(at_b + 2) % 3];
  if (u[(at_b + 1) % 3] != a || are_beside(apex, beyond)) return false;
  const auto is_it = [&](const Edge& mark) { return edge_of(mark[0], mark[1]) == edge_of(a, b); };
  if (std::ranges::any_of(mesh_.marked_edges, is_it)) return false;
  const std::array all{apex, a, beyond, b};
  if (std::ranges::any_of(all, [&](Index v) { return is_taken[v] != 0; })) return false;
  const Point up = chamfers_.plane(part_of_[f]).normal;
  const auto worse = [&](const Corners& one, const Corners& other) {
    return std::min(roundness(one, up), roundness(other, up));
  };
  const Corners first{apex, a, beyond}, second{apex, beyond, b};
  if (worse(first, second) <= worse(t, u)) return false;
  std::ranges::copy(first, mesh_.faces[f].begin());
  std::ranges::copy(second, mesh_.faces[g].begin());
  for (const Index v : all) is_taken[v] = 1;
  turns_.push_back({edge_of(a, b), edge_of(apex, beyond), {f, g}, {t, u}});
  return true;
}

/// The edges that a face got so, if any, and later ones that build on that.
bool ChamferSharpening::turn_back(Index face) {
  std::vector<Index> faces{face};
  std::vector<Edge> gone;
  std::vector<std::size_t> back;
  for (std::size_t k = 0; k < turns_.size(); ++k) {
    const Turn& turn = turns_[k];
    const auto is_of = [&](Index f) { return std::ranges::count(faces, f) > 0; };
    if (!std::ranges::any_of(turn.faces, is_of) && std::ranges::count(gone, turn.to) == 0) continue;
    back.push_back(k);
    gone.push_back(turn.from);
    faces.insert(faces.end(), turn.faces.begin(), turn.faces.end());
  }
  for (const std::size_t k : std::views::reverse(back)) {
    for (std::size_t i = 0; i < 2; ++i) {
      std::ranges::copy(turns_[k].before[i], mesh_.faces[turns_[k].faces[i]].begin());
    }
    turns_.erase(turns_.begin() + static_cast<std::ptrdiff_t>(k));
  }
  return !back.empty();
}

}  // namespace meshgrain
