#include "finish/bad_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "measure/crossings.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

// A face must not be mended by drawing a thin finger into a string.
constexpr BadPlaces::Demands not_poor = {false, 0.3f};
constexpr std::size_t most_spoiled = 2;  // faces that become poor
constexpr std::size_t all = std::numeric_limits<std::size_t>::max();

}  // namespace

std::size_t BadPlaces::most_crossings(const BadPlace& place) {
  return hopeless_crossings * place.faces.size();
}

bool BadPlaces::falls_short(Index f, const Demands& demands) const {
  return search_.quality(f) < demands.quality &&
         (demands.along_surface || search_.quality_among_neighbors(f) < demands.quality);
}

std::size_t BadPlaces::count_short(const BadPlace& place, const Demands& demands,
                                   std::size_t limit) const {
  std::size_t count = 0;
  for (std::size_t k = 0; k < place.faces.size() && count < limit; ++k) {
    count += falls_short(place.faces[k], demands);
  }
  return count;
}

std::size_t BadPlaces::count_crossings(const BadPlace& place, std::size_t limit) const {
  std::vector<Eigen::AlignedBox3f> boxes;
  for (const Index f : place.faces) boxes.push_back(face_box(mesh_, f));
  std::size_t count = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size() && count < limit; ++j) {
      count +=
          boxes[i].intersects(boxes[j]) && cross_if_near(mesh_, place.faces[i], place.faces[j]);
    }
  }
  return count;
}

BadPlace BadPlaces::around(Index f, Index g, int rings) const {
  context_.check();
  BadPlace place;
  place.faces = with_rings(mesh_, around_, {f, g}, rings);
  for (const Index v : vertices_of(mesh_, place.faces)) {
    if (std::ranges::includes(place.faces, around_[v])) place.vertices.push_back(v);
  }
  for (const Index v : place.vertices) place.before.push_back(search_.place(v));
  for (const Index h : place.faces) {
    if (!is_bad(h)) continue;
    ++place.bad;
    for (const Index v : mesh_.faces[h]) {
      if (std::ranges::binary_search(place.vertices, v)) place.at_bad.push_back(v);
    }
  }
  sort_unique(place.at_bad);
  place.poor = count_short(place, not_poor, all);
  place.crossings = count_crossings(place, most_crossings(place));
  return place;
}

std::size_t BadPlaces::wrong(const BadPlace& place, std::size_t limit) const {
  std::size_t sum = 0;
  const auto add = [&](std::size_t allowed, auto&& count) {
    if (sum < limit) sum += std::max(allowed, count(allowed + limit - sum)) - allowed;
  };
  add(place.bad, [&](std::size_t most) { return count_short(place, demands_, most); });
  add(place.poor + most_spoiled,
      [&](std::size_t most) { return count_short(place, not_poor, most); });
  if (place.may_cross) return sum;
  add(place.crossings, [&](std::size_t most) { return count_crossings(place, most); });
  return sum;
}

}  // namespace meshgrain
