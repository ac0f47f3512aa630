#include "sharpen/vertex_merging.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/border.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

Vec3 normal_of(const Vec3& p, const Vec3& q, const Vec3& r) {
  return (q - p).cross(r - p).normalized();
}

}  // namespace

VertexMerging::VertexMerging(const Mesh& triangles, const Context& context)
    : mesh_(triangles),
      around_(vertex_faces(triangles, context)),
      on_rim_(rim_vertices(triangles, context)),
      place_of_(triangles.positions.size(), no_index) {}

void VertexMerging::add_place(std::vector<Index> members) {
  std::ranges::sort(members);
  for (const Index v : members) place_of_[v] = static_cast<Index>(places_.size());
  places_.push_back({.members = std::move(members)});
}

Vec3 VertexMerging::normal(const Corner& corner) const {
  return normal_of(mesh_.positions[corner.member], mesh_.positions[corner.from],
                   mesh_.positions[corner.to]);
}

const VertexMerging::Place* VertexMerging::place_that_goes(Index v) const {
  const Index k = place_of_[v];
  return k != no_index && places_[k].may_go ? &places_[k] : nullptr;
}

Index VertexMerging::into(Index v) const {
  const Place* const place = place_that_goes(v);
  return place != nullptr ? place->members[0] : v;
}

const Vec3& VertexMerging::position_to_be(Index v) const {
  const Place* const place = place_that_goes(v);
  return place != nullptr ? place->at : mesh_.positions[v];
}

bool VertexMerging::will_have_area(const Corner& corner) const {
  const Index member = into(corner.member), from = into(corner.from), to = into(corner.to);
  return from != member && to != member && from != to;
}

Vec3 VertexMerging::normal_to_be(const Corner& corner) const {
  return normal_of(position_to_be(corner.member), position_to_be(corner.from),
                   position_to_be(corner.to));
}

bool VertexMerging::is_disk(const Place& place) const {
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

bool VertexMerging::turns_no_side(const Place& place) const {
  constexpr double degree = std::numbers::pi / 180, little = 15 * degree, nearly = 60 * degree;
  bool stay = true;
  for_each_corner(place.members, [&](const Corner& corner) {
    if (!will_have_area(corner)) return;
    const double most = is_side(corner) ? little : nearly;
    stay = stay && normal(corner).dot(normal_to_be(corner)) > std::cos(most);
  });
  return stay;
}

bool VertexMerging::leave_what_ties_knots() {
  std::vector<std::uint8_t> is_near(mesh_.positions.size(), 0);
  for (const Place& place : places_) {
    if (!place.may_go) continue;
    for_each_corner(place.members, [&](const Corner& corner) {
      for (const Index v : {corner.member, corner.from, corner.to}) is_near[into(v)] = 1;
    });
  }
  std::vector<Index> knots;
  for (Index v = 0; v < is_near.size(); ++v) {
    if (!is_near[v]) continue;
    const Place* const place = place_that_goes(v);
    const std::span<const Index> members =
        place != nullptr ? std::span<const Index>(place->members) : std::span<const Index>(&v, 1);
    if (has_one_ring(members)) continue;
    for_each_corner(members, [&](const Corner& corner) {
      knots.insert(knots.end(), {corner.member, corner.from, corner.to});
    });
  }
  for (const Index v : knots) {
    if (place_of_[v] != no_index) places_[place_of_[v]].may_go = false;
  }
  return !knots.empty();
}

/// Whether what is opposite to vertices that are one will be a ring, or a path on the rim.
bool VertexMerging::has_one_ring(std::span<const Index> members) const {
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
  if (is_path != (is_on_rim(members[0])) || (!is_path && sides < 3)) return false;
  const Index first = is_path ? start->first : next.begin()->first;
  std::size_t steps = 1;
  for (Index at = next.at(first); at != first && next.contains(at); at = next.at(at)) ++steps;
  return steps == sides;
}

void VertexMerging::merge(Mesh& copy) const {
  for (const Place& place : places_) {
    if (place.may_go) copy.positions[place.members[0]] = place.at;
  }
  for (Index& v : copy.faces.corners()) v = into(v);
  for (auto& edge : copy.marked_edges) {
    for (Index& v : edge) v = into(v);
  }
}

}  // namespace meshgrain
