#include "sharpen/narrow_bends.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "features/mechanical_creases.h"
#include "mesh/border.h"
#include "mesh/part.h"
#include "mesh/vertex_normals.h"
#include "meshgrain/clean.h"
#include "sharpen/meet.h"
#include "sharpen/vertex_merging.h"
#include "util/collect.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double crease = 25 * degree;

using Ends = std::array<Index, 2>;

/// The edges of less than `widest`, each once; of those of a border any or none.
std::vector<Ends> short_edges(const Mesh& triangles, double widest, const Context& context) {
  const auto find = [&](std::size_t begin, std::size_t end, std::vector<Ends>& out) {
    const double most = widest * widest;
    for (std::size_t f = begin; f < end; ++f) {
      const auto face = triangles.faces[f];
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = face[k], b = face[(k + 1) % 3];
        const Vec3 side = triangles.positions[b] - triangles.positions[a];
        if (a < b && side.squaredNorm() < most) out.push_back({a, b});
      }
    }
  };
  return collect<Ends>(triangles.faces.size(), find, context);
}

using Place = VertexMerging::Place;
using Corner = VertexMerging::Corner;

/// The angles at which triangles of a bend meet.
struct Folds {
  double inner = 0;  ///< The largest between two of its triangles.
  double outer = 0;  ///< Between one of them and a side.
  double all = 0;    ///< Between two sides.

  /// It bends little by little, and less where it begins. Facets of a cylinder do not.
  bool are_of_rounding() const { return outer < 0.75 * inner && inner < 0.45 * all && all < wall; }
  /// It bends in folds that are creases themselves, none of them nearly all of it.
  bool are_of_chamfer() const {
    const double most = std::max(inner, outer);
    return most > crease && most < 0.75 * all && all < wall;
  }

  static constexpr double wall = 135 * degree;  // whose rim bends all the way round
};

/// The bends that become creases: what lies across one at a vertex is a place.
class NarrowBends {
 public:
  NarrowBends(const Mesh& triangles, std::span<const Ends> edges, const BendWidths& widths,
              const Context& context)
      : positions_(triangles.positions), merging_(triangles, context), widths_(widths) {
    find_places(edges, vertex_normals(triangles, merging_.around(), -1, context), context);
    do {
      leave_what_may_not_go(context);
    } while (leave_parts_of_bends());
  }

  static constexpr std::size_t grain = 16;  // places that are looked at by one thread

  const VertexMerging& merging() const { return merging_; }

  /// The triangles of those that go, and how far their vertices do; without those in the plane of a
  /// side, as there are where a bend ends.
  Mesh bent_triangles(const Mesh& triangles, const Context& context) const {
    std::vector<std::uint8_t> is_face_bent(triangles.faces.size(), 0);
    context.for_ranges(merging_.places().size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const Place& place = merging_.places()[k];
        if (!place.may_go) continue;
        const Sides sides = sides_of(place);
        merging_.for_each_corner(place.members, [&](const Corner& corner) {
          if (!is_bent(corner, sides)) return;
          std::atomic_ref(is_face_bent[corner.face]).store(1, std::memory_order_relaxed);
        });
      }
    });
    std::vector<Index> faces;
    for (Index f = 0; f < is_face_bent.size(); ++f) {
      if (is_face_bent[f]) faces.push_back(f);
    }
    auto [bent, vertices] = part_of(triangles, faces);
    bent.origin = triangles.origin;
    for (const Index v : vertices) {
      bent.values.push_back((merging_.position_to_be(v) - positions_[v]).norm());
    }
    return bent;
  }

 private:
  /// Those that edges join along which normals turn as fast as on a bend that narrow, and not much
  /// faster along others from there: a bend along a curve turns that way, too.
  void find_places(std::span<const Ends> edges, const std::vector<Vec3>& normals,
                   const Context& context) {
    constexpr double bend = 45 * degree, much_faster = 1.5;
    std::vector<double> turns;  // over the width of a narrow bend
    std::vector<double> most(positions_.size(), bend);
    for (const auto& [a, b] : edges) {
      const Vec3 way = positions_[b] - positions_[a], change = normals[b] - normals[a];
      const double cosine = std::clamp<double>(normals[a].dot(normals[b]), -1, 1);
      // Askew, normals change in another direction.
      constexpr float straight = 0.9f;
      const bool is_across = std::abs(way.dot(change)) > straight * way.norm() * change.norm();
      turns.push_back(is_across ? std::acos(cosine) * widths_.rounding / way.norm() : 0);
      for (const Index v : {a, b}) most[v] = std::max(most[v], turns.back());
    }
    UnionFind sets(positions_.size()), close_sets(positions_.size());
    std::vector<std::uint8_t> is_joined(positions_.size(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto& [a, b] = edges[e];
      const double least = std::max(bend, std::min(most[a], most[b]) / much_faster);
      if (merging_.is_on_rim(a) || merging_.is_on_rim(b) || turns[e] < least) continue;
      sets.unite(a, b);
      if ((positions_[b] - positions_[a]).norm() <= widths_.chamfer) close_sets.unite(a, b);
      is_joined[a] = is_joined[b] = 1;
    }
    std::vector<std::vector<Index>> places;
    std::vector<std::uint8_t> are_close;  // each joined by edges as short as narrow chamfers
    std::vector<Index> place_of(positions_.size(), no_index);
    for (Index v = 0; v < positions_.size(); ++v) {
      if (!is_joined[v]) continue;
      const Index root = sets.find(v);  // the lowest
      if (root == v) {
        place_of[v] = static_cast<Index>(places.size());
        places.emplace_back();
        are_close.push_back(1);
      }
      places[place_of[root]].push_back(v);
      if (close_sets.find(v) != close_sets.find(root)) are_close[place_of[root]] = 0;
    }
    for (std::vector<Index>& members : places) merging_.add_place(std::move(members));
    context.for_ranges(places.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        Place& place = merging_.places()[k];
        place.may_go =
            is_narrow(place, are_close[k]) && merging_.is_disk(place) && find_meeting_point(place);
      }
    });
  }

  /// `is_close`: whether edges of the width of narrow chamfers join its members.
  bool is_narrow(const Place& place, bool is_close) const {
    constexpr std::size_t many = 2000;  // as of details of a scan
    if (place.members.size() > many) return false;
    double width = 0;
    for (const Index v : place.members) {
      for (const Index w : place.members) {
        width = std::max<double>(width, (positions_[w] - positions_[v]).norm());
      }
      if (width > widths_.rounding) return false;
    }
    const Folds folds = folds_of(place);
    if (folds.are_of_rounding()) return true;
    constexpr double across_corners = 1.5;
    return is_close && width <= across_corners * widths_.chamfer && folds.are_of_chamfer();
  }

  /// Each only once, as sides may be fans of many triangles.
  std::vector<Vec3> side_normals(const Place& place) const {
    constexpr double equal = 0.1 * degree;
    std::vector<Vec3> normals;
    merging_.for_each_side(place, [&](const Corner& corner) {
      const Vec3 here = merging_.normal(corner);
      const auto is_equal = [&](const Vec3& n) { return angle(here, n) < equal; };
      if (std::ranges::none_of(normals, is_equal)) normals.push_back(here);
    });
    return normals;
  }

  static double angle(const Vec3& m, const Vec3& n) {
    return std::acos(std::clamp(m.dot(n), -1.0f, 1.0f));
  }

  /// What may tell whether a triangle is in the plane of a side.
  struct Sides {
    std::vector<Vec3> normals;
    double in_plane = 3 * degree;
  };

  Sides sides_of(const Place& place) const {
    Sides sides{.normals = side_normals(place)};
    // The first strip of a rounding of many is nearly in that plane.
    constexpr double none = 0.1 * degree, least = 0.2 * degree;
    merging_.for_each_fold(place, [&](const Corner& corner, const Corner& after) {
      const double fold = angle(merging_.normal(corner), merging_.normal(after));
      if (fold > none) sides.in_plane = std::min(sides.in_plane, std::max(least, fold / 2));
    });
    return sides;
  }

  /// Whether a triangle is in the plane of none of the sides.
  bool is_bent(const Corner& corner, const Sides& sides) const {
    const Vec3 here = merging_.normal(corner);
    return std::ranges::none_of(sides.normals,
                                [&](const Vec3& n) { return angle(here, n) < sides.in_plane; });
  }

  Folds folds_of(const Place& place) const {
    const Sides sides = sides_of(place);
    Folds folds;
    merging_.for_each_fold(place, [&](const Corner& corner, const Corner& after) {
      const int bent = is_bent(corner, sides) + is_bent(after, sides);
      if (bent == 0) return;
      double& most = bent == 2 ? folds.inner : folds.outer;
      most = std::max(most, angle(merging_.normal(corner), merging_.normal(after)));
    });
    for (const Vec3& m : sides.normals) {
      for (const Vec3& n : sides.normals) folds.all = std::max(folds.all, angle(m, n));
    }
    return folds;
  }

  /// Of the planes of its sides, each of which counts as much as it is large.
  bool find_meeting_point(Place& place) const {
    Eigen::AlignedBox3d box;
    for (const Index v : place.members) box.extend(position(v));
    std::vector<Plane> planes;
    double area = 0;
    merging_.for_each_side(place, [&](const Corner& corner) {
      const Eigen::Vector3d p = position(corner.member);
      const Eigen::Vector3d n = (position(corner.from) - p).cross(position(corner.to) - p);
      if (!(n.norm() > 0)) return;
      planes.push_back({n / std::sqrt(n.norm()), p});
      area += n.norm();
    });
    for (Plane& plane : planes) plane.normal /= std::sqrt(area);
    const Eigen::Vector3d at = meet(box.center(), planes, 1e-8);
    double off = 0;
    for (const Plane& plane : planes) off += std::pow(plane.height(at), 2);
    place.at = at.cast<float>();
    constexpr double far = 1.5, hardly_off = 0.1;
    const double width = box.diagonal().norm();
    return (at - box.center()).norm() < far * width && std::sqrt(off) < hardly_off * width;
  }

  Eigen::Vector3d position(Index v) const { return positions_[v].cast<double>(); }

  /// Whether sides meet in one that have not met so far.
  bool makes_crease(const Place& place) const {
    std::map<Index, const Corner> next;  // by the vertices that they will follow
    merging_.for_each_corner(place.members, [&](const Corner& corner) {
      if (merging_.will_have_area(corner)) next.emplace(merging_.into(corner.from), corner);
    });
    bool any = false;
    merging_.for_each_corner(place.members, [&](const Corner& corner) {
      const auto found = next.find(merging_.into(corner.to));
      if (found == next.end() || !merging_.will_have_area(corner)) return;
      const Corner& after = found->second;
      const bool have_met = after.member == corner.member && after.from == corner.to;
      any = any || (!have_met && merging_.normal_to_be(corner).dot(merging_.normal_to_be(after)) <
                                     std::cos(crease));
    });
    return any;
  }

  void leave_what_may_not_go(const Context& context) {
    for (bool any = true; any;) {
      context.check();
      any = merging_.leave_what_ties_knots();
      for (Place& place : merging_.places()) {
        if (!place.may_go || (merging_.turns_no_side(place) && makes_crease(place))) continue;
        place.may_go = false;
        any = true;
      }
    }
  }

  /// What is short, or goes only here and there, is no bend or too wide. Returns whether any is.
  bool leave_parts_of_bends() {
    std::vector<Place>& places = merging_.places();
    UnionFind sets(places.size());
    for (Index k = 0; k < places.size(); ++k) {
      merging_.for_each_corner(places[k].members, [&](const Corner& corner) {
        if (merging_.is_side(corner)) return;
        for (const Index v : {corner.from, corner.to}) {
          if (merging_.place_of(v) != no_index) sets.unite(k, merging_.place_of(v));
        }
      });
    }
    struct Bend {
      Eigen::AlignedBox3f box;
      std::size_t vertices = 0, staying = 0;
    };
    std::vector<Bend> bends(places.size());
    for (Index k = 0; k < places.size(); ++k) {
      Bend& bend = bends[sets.find(k)];
      for (const Index v : places[k].members) bend.box.extend(positions_[v]);
      bend.vertices += places[k].members.size();
      if (!places[k].may_go) bend.staying += places[k].members.size();
    }
    constexpr std::size_t at_most_one_of = 3;
    constexpr double longer = 2;
    bool any = false;
    for (Index k = 0; k < places.size(); ++k) {
      const Bend& bend = bends[sets.find(k)];
      const bool is_long = bend.box.diagonal().norm() > longer * widths_.rounding;
      const bool goes = is_long && at_most_one_of * bend.staying <= bend.vertices;
      if (!goes && std::exchange(places[k].may_go, false)) any = true;
    }
    return any;
  }

  const std::vector<Vec3>& positions_;
  VertexMerging merging_;
  BendWidths widths_;
};

}  // namespace

Mesh sharpen_bends(Mesh& triangles, const BendWidths& widths, const Context& context) {
  const std::vector<Ends> edges = short_edges(triangles, widths.rounding, context);
  if (edges.empty()) return {};
  const NarrowBends bends(triangles, edges, widths, context);
  Mesh bent = bends.bent_triangles(triangles, context);
  if (bent.faces.empty()) return {};
  Mesh sharp = triangles;
  bends.merging().merge(sharp);
  clean(sharp, context);
  // Of sculptures these are details like any.
  const RimAndSharpEdges sharp_edges = rim_and_sharp_edges(sharp, flat_degrees, context);
  if (kind_of_surface(sharp, sharp_edges, context) == SurfaceKind::sculpture) return {};
  triangles = std::move(sharp);
  return bent;
}

}  // namespace meshgrain
