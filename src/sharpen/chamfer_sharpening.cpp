#include "sharpen/chamfer_sharpening.h"

#include <cmath>
#include <limits>
#include <utility>

#include "measure/crossings.h"
#include "mesh/border.h"
#include "mesh/splitting.h"
#include "sharpen/meet.h"
#include "util/edge_of.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

using Point = ChamferSharpening::Point;
using Edge = ChamferSharpening::Edge;

constexpr std::size_t grain = 512;

/// Whether two parts are the sides of a wedge so sharp that where it ends, thinner than a cell of
/// the grid, they tell nothing.
bool is_thin(std::span<const Plane> planes) {
  constexpr double cosine = -0.866;  // of 150 degrees between the normals
  return planes.size() == 2 && planes[0].normal.dot(planes[1].normal) < cosine;
}

Point cut_to(double length, const Point& way) {
  const double norm = way.norm();
  return norm > length ? Point(length / norm * way) : way;
}

}  // namespace

ChamferSharpening::ChamferSharpening(Mesh& mesh, const Context& context)
    : mesh_(mesh),
      before_(mesh),
      context_(context),
      chamfers_(before_, edges, context),
      rim_(rim_edges(mesh, context)),
      stays_(mark_ends(rim_, mesh.positions.size())),
      is_on_(mesh.positions.size(), 0) {
  move_vertices();
  end_at_rim();
  split();
  find_parts_of_faces();
  place_corners();
  space_out();
  keep_apart();
}

std::vector<Edge> ChamferSharpening::creases() const {
  const auto is_crease = [&](const InnerEdge& e) {
    const Index a = part_of_[e.left], b = part_of_[e.right];
    return is_on_[e.ends[0]] && is_on_[e.ends[1]] && a != no_index && b != no_index &&
           chamfers_.meet_in_crease(a, b);
  };
  std::vector<Edge> result;
  for (const InnerEdge& e : inner_edges(mesh_, is_crease, context_)) result.push_back(e.ends);
  return result;
}

std::size_t ChamferSharpening::loose_ends(std::span<const Edge> creases) const {
  std::vector<Index> ends;
  for (const Edge& edge : creases) ends.insert(ends.end(), edge.begin(), edge.end());
  std::ranges::sort(ends);
  std::size_t count = 0;
  for (std::size_t k = 0; k < ends.size();) {
    const std::size_t first = k;
    while (k < ends.size() && ends[k] == ends[first]) ++k;
    count += k == first + 1 && !stays_[ends[first]];
  }
  return count;
}

void ChamferSharpening::give_up_loose() {
  constexpr std::size_t short_line = 20;  // edges; a longer one is a crease, though a gap ends it
  constexpr int reach = 2;
  std::vector<Index> given_up;
  for (Index end = 0; end < mesh_.positions.size(); ++end) {
    if (on_crease_beside_[end].size() != 1 || stays_[end]) continue;
    std::vector<Index> line;
    Index before = no_index, v = end;
    while (on_crease_beside_[v].size() <= 2 && line.size() <= short_line) {
      line.push_back(v);
      const auto& beside = on_crease_beside_[v];
      const auto next = std::ranges::find_if(beside, [&](Index w) { return w != before; });
      if (next == beside.end()) break;
      before = std::exchange(v, *next);
    }
    if (line.size() <= short_line) given_up.insert(given_up.end(), line.begin(), line.end());
  }
  if (given_up.empty()) return;
  for (const Index v : given_up) is_on_[v] = 0;
  grow(given_up, reach);
  for (const Index v : given_up) {
    if (is_on_[v]) continue;
    for (const Index f : around_[v]) turn_back(f);
    mesh_.positions[v] = origins_[v];
  }
  keep_apart();
}

/// Those of chamfers onto their parts, and of those near to a crease the nearest ones onto it.
void ChamferSharpening::move_vertices() {
  struct Move {
    double way = std::numeric_limits<double>::infinity();
    Point to;
  };
  const std::size_t count = before_.positions.size();
  std::vector<Move> moves(count);
  context_.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      if (!chamfers_.has_part(v) || stays_[v]) continue;
      const Point p = chamfers_.position(v);
      const Plane own = chamfers_.plane(v);
      const Point up = -own.height(p) * own.normal;
      if (!chamfers_.is_smooth(v) && up.norm() < chamfers_.edge()) {
        mesh_.positions[v] = (p + up).cast<float>();
      }
      chamfers_.each_beside(v, [&](Index w) {
        if (!chamfers_.meet_in_crease(v, w)) return;
        const Point to = meet(p, std::array{own, chamfers_.plane(w)});
        const double way = (to - p).norm();
        if (way < near * chamfers_.edge() && way < moves[v].way) moves[v] = {way, to};
      });
    }
  });
  const auto is_nearest = [&](Index v) {
    return !chamfers_.any_beside(v, [&](Index w) {
      return chamfers_.meet_in_crease(v, w) &&
             std::pair(moves[w].way, w) < std::pair(moves[v].way, v);
    });
  };
  context_.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      if (!std::isfinite(moves[v].way) || !is_nearest(v)) continue;
      mesh_.positions[v] = moves[v].to.cast<float>();
      is_on_[v] = 1;
    }
  });
}

/// Creases at the nearer end of each edge of it that they would cross: no vertex may be put in
/// there.
void ChamferSharpening::end_at_rim() {
  for (const auto& [a, b] : rim_) {
    if (!is_crossed(a, b)) continue;
    const std::array planes{chamfers_.plane(a), chamfers_.plane(b)};
    const auto off = [&](Index v) {
      return (meet(chamfers_.position(v), planes) - chamfers_.position(v)).norm();
    };
    is_on_[off(b) < off(a) ? b : a] = 1;
  }
}

/// Edges that a crease crosses, and faces in which three meet.
void ChamferSharpening::split() {
  std::vector<Edge> crossed;
  std::vector<Index> with_corner;
  for (Index f = 0; f < before_.faces.size(); ++f) {
    const auto c = before_.faces[f];
    std::size_t crossings = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = c[k], b = c[(k + 1) % 3];
      if (!is_crossed(a, b)) continue;
      crossed.push_back(edge_of(a, b));
      ++crossings;
    }
    if (crossings == 3) with_corner.push_back(f);
  }
  sort_unique(crossed);
  origins_ = before_.positions;
  Splitting splitting(mesh_, context_);
  const auto place = [&](Index added, const Point& origin, std::span<const Plane> planes) {
    Point to = origin;
    if (!is_thin(planes)) to += cut_to(far * chamfers_.edge(), meet(origin, planes) - origin);
    mesh_.positions[added] = to.cast<float>();
    origins_.push_back(origin.cast<float>());
  };
  for (const Index f : with_corner) {
    const auto c = before_.faces[f];
    const std::array planes{chamfers_.plane(c[0]), chamfers_.plane(c[1]), chamfers_.plane(c[2])};
    const Point middle =
        (chamfers_.position(c[0]) + chamfers_.position(c[1]) + chamfers_.position(c[2])) / 3;
    place(splitting.split_face(f, {1. / 3, 1. / 3, 1. / 3}), middle, planes);
  }
  for (const auto& [a, b] : crossed) {
    const Point middle = (chamfers_.position(a) + chamfers_.position(b)) / 2;
    place(splitting.split_edge(a, b, 0.5), middle,
          std::array{chamfers_.plane(a), chamfers_.plane(b)});
  }
  is_on_.resize(mesh_.positions.size(), 1);
  stays_.resize(mesh_.positions.size(), 0);
  around_ = vertex_faces(mesh_, context_);
}

/// A face is of the part of its corners that are not on a crease; one that has none is of that of a
/// face beside it.
void ChamferSharpening::find_parts_of_faces() {
  part_of_.assign(mesh_.faces.size(), no_index);
  std::vector<Index> open;
  for (Index f = 0; f < part_of_.size(); ++f) {
    for (const Index v : std::as_const(mesh_.faces)[f]) {
      if (!is_on_[v] && chamfers_.has_part(v)) part_of_[f] = v;
    }
    if (part_of_[f] == no_index) open.push_back(f);
  }
  while (!open.empty()) {
    std::vector<std::pair<Index, Index>> found;
    std::vector<Index> still_open;
    for (const Index f : open) {
      const Index part = part_beside(f);
      if (part != no_index) {
        found.emplace_back(f, part);
      } else {
        still_open.push_back(f);
      }
    }
    if (found.empty()) return;
    for (const auto& [f, part] : found) part_of_[f] = part;
    open = std::move(still_open);
  }
}

/// The one that looks most the way that the face does.
Index ChamferSharpening::part_beside(Index f) const {
  const auto c = std::as_const(mesh_.faces)[f];
  const auto at = [&](std::size_t k) -> Point { return mesh_.positions[c[k]].cast<double>(); };
  const Point normal = (at(1) - at(0)).cross(at(2) - at(0));
  Index part = no_index;
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    for (const Index g : around_[c[k]]) {
      const auto other = std::as_const(mesh_.faces)[g];
      const bool is_beside = corner_of(other, c[(k + 1) % 3]) < other.size();
      if (part_of_[g] == no_index || !is_beside) continue;
      const double agrees = chamfers_.plane(part_of_[g]).normal.dot(normal);
      if (agrees <= best) continue;
      best = agrees;
      part = part_of_[g];
    }
  }
  return part;
}

/// Planes that touch the parts around a vertex, one of those that would meet in no crease.
std::vector<Plane> ChamferSharpening::parts_around(Index v) const {
  std::vector<Plane> planes;
  for (const Index f : around_[v]) {
    if (part_of_[f] == no_index) continue;
    const Plane plane = chamfers_.plane(part_of_[f]);
    const auto differs = [&](const Plane& other) { return meet_in_crease(plane, other); };
    if (std::ranges::all_of(planes, differs)) planes.push_back(plane);
  }
  return planes;
}

/// Vertices on creases around which three parts or more meet.
void ChamferSharpening::place_corners() {
  context_.for_ranges(mesh_.positions.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      if (!is_on_[v] || stays_[v]) continue;
      const std::vector<Plane> planes = parts_around(v);
      if (planes.size() < 3) continue;
      const Point p = mesh_.positions[v].cast<double>(), corner = meet(p, planes);
      if ((corner - p).norm() < far_corner * chamfers_.edge()) {
        mesh_.positions[v] = corner.cast<float>();
      }
    }
  });
}

/// Puts vertices back at which the surface would pass through itself, as where it has a gap or a
/// wall hardly wider than a chamfer.
void ChamferSharpening::keep_apart() {
  constexpr double deep = 0.05;  // edges; slivers side by side may seem to cross a little
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [f, g] : find_crossings(mesh_, context_)) {
      if (penetration(mesh_, f, g) < deep * chamfers_.edge()) continue;
      for (const Index face : {f, g}) {
        changed |= turn_back(face);
        for (const Index v : std::as_const(mesh_.faces)[face]) {
          if (mesh_.positions[v] == origins_[v]) continue;
          mesh_.positions[v] = origins_[v];
          put_back_ += is_on_[v];
          changed = true;
        }
      }
    }
  }
}

}  // namespace meshgrain
