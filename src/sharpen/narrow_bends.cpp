#include "sharpen/narrow_bends.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "features/mechanical_creases.h"
#include "mesh/border.h"
#include "mesh/next_corners.h"
#include "mesh/part.h"
#include "mesh/vertex_faces.h"
#include "mesh/vertex_normals.h"
#include "meshgrain/clean.h"
#include "util/collect.h"
#include "util/sort_unique.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

constexpr double degree = std::numbers::pi / 180;

using Ends = std::array<Index, 2>;

/// The edges of less than `widest`, each once unless on a border.
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

Vec3 normal(const Vec3& p, const Vec3& q, const Vec3& r) {
  return (q - p).cross(r - p).normalized();
}

/// Vertices across a bend that are to become one.
struct Place {
  std::vector<Index> members;  // in increasing order; the first stands for all
  Vec3 at;                     // where the sides meet
  bool is_close = true;        // joined by edges of the width of narrow chamfers
  bool may_go = true;
};

/// A triangle at a member, its two other corners in order.
struct Corner {
  Index member, from, to, face;
};

class NarrowBends {
 public:
  NarrowBends(const Mesh& triangles, std::span<const Ends> edges, const BendWidths& widths,
              const Context& context)
      : mesh_(triangles),
        around_(vertex_faces(triangles, context)),
        widths_(widths),
        on_rim_(rim_vertices(triangles, context)),
        place_of_(triangles.positions.size(), no_index) {
    find_places(edges, vertex_normals(triangles, around_, -1, context));
    for (Place& place : places_) {
      place.may_go = is_narrow(place) && is_disk(place) && find_meeting_point(place);
    }
    keep_what_may_not_go(context);
    keep_parts_of_bends();
  }

  /// The triangles across those that go.
  std::vector<Index> faces_across() const {
    std::vector<Index> faces;
    for (const Place& place : places_) {
      if (!place.may_go) continue;
      for_each_corner(place.members, [&](const Corner& corner) {
        if (!is_side(corner)) faces.push_back(corner.face);
      });
    }
    sort_unique(faces);
    return faces;
  }

  void close(Mesh& mesh) const {
    for (const Place& place : places_) {
      if (place.may_go) mesh.positions[place.members[0]] = place.at;
    }
    for (Index& v : mesh.faces.corners()) v = into(v);
    for (auto& edge : mesh.marked_edges) {
      for (Index& v : edge) v = into(v);
    }
  }

 private:
  /// Those that edges join along which normals turn as fast as on a bend that narrow, and not much
  /// faster along others from there: a bend along a curve turns that way, too.
  void find_places(std::span<const Ends> edges, const std::vector<Vec3>& normals) {
    constexpr double bend = 45 * degree, much_faster = 1.5;
    std::vector<double> turns;  // over the width of a narrow bend
    std::vector<double> most(mesh_.positions.size(), bend);
    for (const auto& [a, b] : edges) {
      const Vec3 way = mesh_.positions[b] - mesh_.positions[a], change = normals[b] - normals[a];
      const double cosine = std::clamp<double>(normals[a].dot(normals[b]), -1, 1);
      // Askew, normals change in another direction.
      constexpr float straight = 0.9f;
      const bool is_across = std::abs(way.dot(change)) > straight * way.norm() * change.norm();
      turns.push_back(is_across ? std::acos(cosine) * widths_.rounding / way.norm() : 0);
      for (const Index v : {a, b}) most[v] = std::max(most[v], turns.back());
    }
    UnionFind sets(mesh_.positions.size()), close_sets(mesh_.positions.size());
    std::vector<Index> joined;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto& [a, b] = edges[e];
      const double least = std::max(bend, std::min(most[a], most[b]) / much_faster);
      if (on_rim_[a] || on_rim_[b] || turns[e] < least) continue;
      sets.unite(a, b);
      const float length = (mesh_.positions[b] - mesh_.positions[a]).norm();
      if (length <= widths_.chamfer) close_sets.unite(a, b);
      joined.insert(joined.end(), {a, b});
    }
    sort_unique(joined);
    for (const Index v : joined) {
      const Index root = sets.find(v);  // the lowest, which comes first
      if (root == v) places_.emplace_back();
      place_of_[v] = root == v ? static_cast<Index>(places_.size() - 1) : place_of_[root];
      Place& place = places_[place_of_[v]];
      place.members.push_back(v);
      place.is_close = place.is_close && close_sets.find(v) == close_sets.find(root);
    }
  }

  static bool has(const Place& place, Index v) {
    return std::ranges::binary_search(place.members, v);
  }

  bool are_of_one_place(Index v, Index w) const {
    return place_of_[v] != no_index && place_of_[v] == place_of_[w];
  }

  /// Whether a triangle is beside the bend, not of it.
  bool is_side(const Corner& corner) const {
    return !are_of_one_place(corner.member, corner.from) &&
           !are_of_one_place(corner.from, corner.to) && !are_of_one_place(corner.to, corner.member);
  }

  template <typename Body>
  void for_each_corner(std::span<const Index> members, const Body& body) const {
    for (const Index v : members) {
      for (const Index f : around_[v]) {
        const auto [from, to] = next_corners(mesh_.faces[f].data(), v);
        body(Corner{v, from, to, f});
      }
    }
  }

  template <typename Body>
  void for_each_side(const Place& place, const Body& body) const {
    for_each_corner(place.members, [&](const Corner& corner) {
      if (is_side(corner)) body(corner);
    });
  }

  /// Of pairs of triangles, one after the other, at edges from members to others.
  template <typename Body>
  void for_each_fold(const Place& place, const Body& body) const {
    std::map<Ends, const Corner> next;  // by the edges that they follow
    for_each_corner(place.members, [&](const Corner& corner) {
      next.emplace(Ends{corner.member, corner.from}, corner);
    });
    for_each_corner(place.members, [&](const Corner& corner) {
      if (!has(place, corner.to)) body(corner, next.at({corner.member, corner.to}));
    });
  }

  Vec3 face_normal(Index f) const {
    const auto face = mesh_.faces[f];
    return normal(mesh_.positions[face[0]], mesh_.positions[face[1]], mesh_.positions[face[2]]);
  }

  bool is_narrow(const Place& place) const {
    constexpr std::size_t many = 2000;  // as of details of a scan
    if (place.members.size() > many) return false;
    for (const Index v : place.members) {
      const Vec3& p = mesh_.positions[v];
      const auto is_far = [&](Index w) {
        return (mesh_.positions[w] - p).norm() > widths_.rounding;
      };
      if (std::ranges::any_of(place.members, is_far)) return false;
    }
    // Roundings bend little by little, and not in a few folds that are creases themselves.
    constexpr double few = 0.45;
    const double fold = sharpest_fold(place);
    return fold > 0 && (place.is_close || fold < few);
  }

  /// Of the whole bend; 0 if none of its triangles is bent away from all sides.
  double sharpest_fold(const Place& place) const {
    std::vector<Vec3> sides;
    for_each_side(place, [&](const Corner& corner) { sides.push_back(face_normal(corner.face)); });
    constexpr double in_plane = 3 * degree;
    const auto is_bent = [&](const Corner& corner) {
      const Vec3 here = face_normal(corner.face);
      return std::ranges::none_of(
          sides, [&](const Vec3& side) { return here.dot(side) > std::cos(in_plane); });
    };
    float fold = 1, bend = 1;  // the cosines of their angles
    for_each_fold(place, [&](const Corner& corner, const Corner& after) {
      if (!is_bent(corner) && !is_bent(after)) return;
      fold = std::min(fold, face_normal(corner.face).dot(face_normal(after.face)));
    });
    for (const Vec3& m : sides) {
      for (const Vec3& n : sides) bend = std::min(bend, m.dot(n));
    }
    return bend < 1 ? std::acos(fold) / std::acos(bend) : 0;
  }

  /// Whether its own edges and triangles make up a disk, or a path.
  bool is_disk(const Place& place) const {
    std::ptrdiff_t ends = 0, corners = 0;
    for_each_corner(place.members, [&](const Corner& corner) {
      const std::ptrdiff_t others = has(place, corner.from) + has(place, corner.to);
      ends += others;
      corners += others == 2;
    });
    // Every edge has two triangles, and in each of them two ends.
    const auto vertices = static_cast<std::ptrdiff_t>(place.members.size());
    return vertices - ends / 4 + corners / 3 == 1;
  }

  /// Of the planes of its sides, each of which counts as much as it is large.
  bool find_meeting_point(Place& place) const {
    struct Side {
      Eigen::Vector3d normal;
      double height, area;
    };
    Eigen::AlignedBox3d box;
    for (const Index v : place.members) box.extend(mesh_.positions[v].cast<double>());
    const Eigen::Vector3d middle = box.center();
    const auto position = [&](Index v) -> Eigen::Vector3d {
      return mesh_.positions[v].cast<double>() - middle;
    };
    std::vector<Side> sides;
    double area = 0;
    for_each_side(place, [&](const Corner& corner) {
      const Eigen::Vector3d p = position(corner.member);
      const Eigen::Vector3d n = (position(corner.from) - p).cross(position(corner.to) - p);
      if (!(n.norm() > 0)) return;
      sides.push_back({n.normalized(), n.normalized().dot(p), n.norm()});
      area += n.norm();
    });
    constexpr double hardly = 1e-8;  // held where it is along what the sides leave open
    Eigen::Matrix3d matrix = hardly * Eigen::Matrix3d::Identity();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Side& side : sides) {
      matrix += side.area / area * side.normal * side.normal.transpose();
      right += side.area / area * side.height * side.normal;
    }
    const Eigen::Vector3d way = matrix.ldlt().solve(right);
    double off = 0;
    for (const Side& side : sides) {
      off += side.area / area * std::pow(side.normal.dot(way) - side.height, 2);
    }
    place.at = (middle + way).cast<float>();
    constexpr double far = 1.5, hardly_off = 0.1;
    const double width = box.diagonal().norm();
    return way.norm() < far * width && std::sqrt(off) < hardly_off * width;
  }

  const Place* place_that_goes(Index v) const {
    const Index k = place_of_[v];
    return k != no_index && places_[k].may_go ? &places_[k] : nullptr;
  }
  Index into(Index v) const {
    const Place* const place = place_that_goes(v);
    return place != nullptr ? place->members[0] : v;
  }
  const Vec3& position(Index v) const {
    const Place* const place = place_that_goes(v);
    return place != nullptr ? place->at : mesh_.positions[v];
  }

  bool will_have_area(const Corner& corner) const {
    const Index member = into(corner.member), from = into(corner.from), to = into(corner.to);
    return from != member && to != member && from != to;
  }
  Vec3 normal_to_be(const Corner& corner) const {
    return normal(position(corner.member), position(corner.from), position(corner.to));
  }

  bool turns_no_side(const Place& place) const {
    constexpr double little = 15 * degree, much = 60 * degree;
    bool stay = true;
    for_each_corner(place.members, [&](const Corner& corner) {
      if (!will_have_area(corner)) return;
      // Others lead to where the bend stays.
      const double most = is_side(corner) ? little : much;
      stay = stay && face_normal(corner.face).dot(normal_to_be(corner)) > std::cos(most);
    });
    return stay;
  }

  /// Whether sides meet in one that have not met so far.
  bool makes_crease(const Place& place) const {
    std::map<Index, const Corner> next;  // by the vertices that they will follow
    for_each_corner(place.members, [&](const Corner& corner) {
      if (will_have_area(corner)) next.emplace(into(corner.from), corner);
    });
    constexpr double crease = 25 * degree;
    bool any = false;
    for_each_corner(place.members, [&](const Corner& corner) {
      const auto found = next.find(into(corner.to));
      if (found == next.end() || !will_have_area(corner)) return;
      const Corner& after = found->second;
      const bool have_met = after.member == corner.member && after.from == corner.to;
      any = any || (!have_met && normal_to_be(corner).dot(normal_to_be(after)) < std::cos(crease));
    });
    return any;
  }

  void keep_what_may_not_go(const Context& context) {
    for (bool any = true; std::exchange(any, false);) {
      context.check();
      for (Place& place : places_) {
        if (!place.may_go) continue;
        if (turns_no_side(place) && makes_crease(place) && keeps_topology(place)) continue;
        place.may_go = false;
        any = true;
      }
    }
  }

  /// Bends go as a whole. What is short, or goes only here and there, is none or too wide.
  void keep_parts_of_bends() {
    UnionFind sets(places_.size());
    for (Index k = 0; k < places_.size(); ++k) {
      for_each_corner(places_[k].members, [&](const Corner& corner) {
        if (is_side(corner)) return;
        for (const Index v : {corner.from, corner.to}) {
          if (place_of_[v] != no_index) sets.unite(k, place_of_[v]);
        }
      });
    }
    struct Bend {
      Eigen::AlignedBox3f box;
      std::size_t vertices = 0, staying = 0;
    };
    std::vector<Bend> bends(places_.size());
    for (Index k = 0; k < places_.size(); ++k) {
      Bend& bend = bends[sets.find(k)];
      for (const Index v : places_[k].members) bend.box.extend(mesh_.positions[v]);
      bend.vertices += places_[k].members.size();
      if (!places_[k].may_go) bend.staying += places_[k].members.size();
    }
    constexpr std::size_t few = 3;  // one of as many
    constexpr double longer = 2;
    for (Index k = 0; k < places_.size(); ++k) {
      const Bend& bend = bends[sets.find(k)];
      const bool is_long = bend.box.diagonal().norm() > longer * widths_.rounding;
      if (!is_long || few * bend.staying > bend.vertices) places_[k].may_go = false;
    }
  }

  /// Of the vertices of all triangles around it.
  bool keeps_topology(const Place& place) const {
    std::vector<Index> near = vertices_of(mesh_, faces_of(around_, place.members));
    return std::ranges::all_of(near, [&](Index v) {
      const Place* const other = place_that_goes(v);
      return other != nullptr ? has_one_ring(other->members) : has_one_ring({&v, 1});
    });
  }

  /// Whether what is opposite to vertices that are one will be a ring, or a path on the rim.
  bool has_one_ring(std::span<const Index> members) const {
    std::map<Index, Index> next;
    std::vector<Index> last;
    for_each_corner(members, [&](const Corner& corner) {
      if (!will_have_area(corner)) return;
      next.emplace(into(corner.from), into(corner.to));
      last.push_back(into(corner.to));
    });
    const std::size_t sides = last.size();
    sort_unique(last);
    if (sides == 0 || last.size() < sides || next.size() < sides) return false;
    const auto is_start = [&](const auto& side) {
      return !std::ranges::binary_search(last, side.first);
    };
    const auto start = std::ranges::find_if(next, is_start);
    const bool is_path = start != next.end();
    if (is_path != (on_rim_[members[0]] != 0) || (!is_path && sides < 3)) return false;
    const Index first = is_path ? start->first : next.begin()->first;
    std::size_t steps = 1;
    for (Index at = next.at(first); at != first && next.contains(at); at = next.at(at)) ++steps;
    return steps == sides;
  }

  const Mesh& mesh_;
  VertexFaces around_;
  BendWidths widths_;
  std::vector<std::uint8_t> on_rim_;
  std::vector<Index> place_of_;
  std::vector<Place> places_;
};

}  // namespace

Mesh sharpen_bends(Mesh& triangles, const BendWidths& widths, const Context& context) {
  const std::vector<Ends> edges = short_edges(triangles, widths.rounding, context);
  if (edges.empty()) return {};
  const NarrowBends bends(triangles, edges, widths, context);
  const std::vector<Index> across = bends.faces_across();
  if (across.empty()) return {};
  Mesh sharp = triangles;
  bends.close(sharp);
  clean(sharp, context);
  // Of sculptures these are details like any.
  const RimAndSharpEdges sharp_edges = rim_and_sharp_edges(sharp, flat_degrees, context);
  if (kind_of_surface(sharp, sharp_edges, context) == SurfaceKind::sculpture) return {};
  Mesh bent = part_of(triangles, across).mesh;
  triangles = std::move(sharp);
  return bent;
}

}  // namespace meshgrain
