#include "finish/mend_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "finish/bad_places.h"
#include "finish/crossing_pairs.h"
#include "finish/surface_crossings.h"
#include "measure/crossings.h"
#include "measure/face_shape.h"
#include "mesh/border.h"
#include "util/shortened.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

class Mending {
 public:
  Mending(const Mesh& mesh, const VertexFaces& around, Placement& placement, LocalSearch& search,
          const SmoothOptions& options, const Context& context)
      : mesh_(mesh),
        placement_(placement),
        search_(search),
        places_(mesh, around, search, context),
        surface_crossings_(placement.projector(), context),
        options_(options),
        context_(context) {}

  void run() {
    if (!options_.is_part) part_crossings();
    failed_slides_ = 0;
    effort_left_ = 0;
    for (const BadPlaces::Demands& demands : ever_less) {
      demand(demands);
      for (const int rings : ever_wider) reshape_all(rings);
    }
  }

 private:
  /// What decides how a slide ends.
  struct Start {
    std::vector<Index> faces;
    std::vector<Vec3> corners;
    std::size_t on_lines;  // corners that may not leave a feature
    std::size_t crossings, bad;
    bool may_cross;

    bool operator==(const Start&) const = default;
  };

  // Across a fold that is narrower than a face, faces cannot look where the surface does there.
  static constexpr BadPlaces::Demands ever_less[] = {{true, 0.1f}, {false, 0.1f}, {false, 0}};
  static constexpr int ever_wider[] = {2, 3, 5};  // rings of faces around the bad ones

  static constexpr int sweeps = 5;                     // of a slide
  static constexpr std::size_t largest_to_slide = 80;  // faces of a place: it takes long
  static constexpr std::size_t most_crossings_to_slide = 25;
  static constexpr std::size_t most_failed_slides = 16;  // in all, and one more for so many faces:
  static constexpr std::size_t faces_a_failed_slide = 4000;
  // A mesh with more bad places is too coarse for its surface: no need to try for minutes.
  static constexpr std::size_t most_tried = 50;
  // For the same reason all that is tried for one of the demands has an end: in steps of a face.
  static constexpr double effort_for_a_mesh = 1500000, effort_for_a_part = 20000;
  static constexpr double effort_a_face = 60, effort_to_slide_a_face = 1500;
  // That a face takes part in without success, and one that is bad.
  static constexpr std::size_t tries = 6, tries_to_reshape = 4;

  /// To look at a place once. Large ones, where a mesh is crumpled, have few faces that are not
  /// compared with each other.
  static double steps_to_look_at(const BadPlace& place) {
    constexpr double large = 150;
    const auto faces = static_cast<double>(place.faces.size());
    return faces * std::max(1.0, std::pow(faces / large, 2)) + static_cast<double>(place.crossings);
  }

  double effort() const {
    if (options_.is_part) return effort_for_a_part;
    const double all = effort_for_a_mesh + effort_a_face * static_cast<double>(mesh_.faces.size());
    return is_crumpled_ ? effort_if_crumpled * all : all;
  }

  void demand(const BadPlaces::Demands& demands) {
    places_.demand(demands);
    effort_left_ += effort();
    failed_starts_.clear();
  }

  void part_crossings() {
    std::vector<std::uint8_t> inherent(mesh_.faces.size(), 0);  // beside crossings of the surface
    CrossingPairs crossings(mesh_, context_);
    is_crumpled_ = is_crumpled(crossings.all().size(), mesh_.faces.size());
    for (const BadPlaces::Demands& demands : ever_less) {
      demand(demands);
      bool few = true;
      for (const int rings : ever_wider) {
        if (crossings.all().empty()) return;
        few = part_all(crossings.all(), rings, inherent) && few;
        crossings.update();
      }
      // Poor faces are worth it only for a result that passes through itself nowhere.
      if (!few || std::ranges::count(inherent, 1) > 0) return;
    }
  }

  /// Returns false if there are too many places.
  bool part_all(const std::vector<std::array<Index, 2>>& crossings, int rings,
                std::vector<std::uint8_t>& inherent) {
    std::size_t tried = 0;
    // Each of the many pairs in a place that cannot be mended has about the same place.
    std::vector<std::size_t> failed(mesh_.faces.size(), 0);
    for (const auto& [f, g] : crossings) {
      if (inherent[f] || inherent[g] || std::min(failed[f], failed[g]) >= tries) continue;
      if (penetration(mesh_, f, g) == 0) continue;
      if (effort_left_ <= 0) return false;
      BadPlace place = places_.around(f, g, rings);
      effort_left_ -= steps_to_look_at(place);
      if (BadPlaces::is_hopeless(place) || surface_crosses(place)) {
        inherent[f] = inherent[g] = 1;
        continue;
      }
      if (++tried > most_tried) return false;
      --place.crossings;
      if (part(place)) continue;
      restore(place);
      for (const Index h : place.faces) ++failed[h];
    }
    return true;
  }

  void reshape_all(int rings) {
    std::size_t tried = 0;
    std::vector<std::size_t> failed(mesh_.faces.size(), 0);
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      if (failed[f] >= tries_to_reshape || !places_.is_bad(f)) continue;
      if (++tried > std::max(most_tried, mesh_.faces.size() / 100) || effort_left_ <= 0) break;
      BadPlace place = places_.around(f, f, rings);
      effort_left_ -= steps_to_look_at(place);
      if (BadPlaces::is_hopeless(place)) {
        for (const Index h : place.faces) ++failed[h];
        continue;
      }
      --place.bad;
      // What could not be parted must not keep faces turned inside out as well.
      const bool is_last = places_.demands().quality <= 0;
      place.may_cross =
          place.crossings > 0 && !options_.is_part && (is_last || surface_crosses(place));
      if (reshape(place)) continue;
      restore(place);
      for (const Index h : place.faces) ++failed[h];
    }
  }

  bool may_slide(const BadPlace& place) const {
    return place.faces.size() <= largest_to_slide &&
           (place.may_cross || place.crossings <= most_crossings_to_slide) &&
           failed_slides_ < (options_.is_part
                                 ? 1
                                 : most_failed_slides + mesh_.faces.size() / faces_a_failed_slide);
  }

  bool part(const BadPlace& place) {
    if (may_slide(place)) {
      if (slide(place)) return true;
      restore(place);
    }
    if (loosen(place, Who::free) || (may_slide(place) && slide(place))) return true;
    restore(place);
    return loosen(place, Who::free_and_ends);
  }

  /// Ends that are held go before features do.
  bool reshape(const BadPlace& place) {
    for (const Who who : {Who::free, Who::free_and_ends}) {
      if (loosen(place, who) || (may_slide(place) && slide(place))) return true;
      restore(place);
    }
    if (may_slide(place)) {
      if (leave_lines(place)) return true;
      restore(place);
    }
    return loosen(place, Who::free_and_at_bad);
  }

  /// Or is too fine to tell.
  bool surface_crosses(const BadPlace& place) {
    std::vector<Index> nodes;
    Eigen::AlignedBox3f box;
    for (const LocalSearch::Place& at : place.before) {
      nodes.push_back(placement_.node(at.seed));
      box.extend(at.position);
    }
    return surface_crossings_.any_in(box, std::move(nodes));
  }

  void restore(const BadPlace& place) { search_.put(place.vertices, place.before); }

  /// Over the surface. Returns whether the place is mended.
  bool slide(const BadPlace& place) {
    // Pairs of faces, and ways to begin, often lead to the same.
    Start start = start_of(place);
    if (std::ranges::find(failed_starts_, start) != failed_starts_.end()) return false;
    effort_left_ -= effort_to_slide_a_face * static_cast<double>(place.faces.size());
    search_.keep_apart(place.may_cross ? std::vector<Index>() : place.faces);
    for (const Index v : place.vertices) search_.touch(v);
    int left = sweeps;
    while (left > 0 && search_.improve(place.vertices, 1, context_)) {
      if (is_in_vain(place, --left)) break;
    }
    search_.keep_apart({});
    if (places_.is_mended(place)) return true;
    ++failed_slides_;
    failed_starts_.push_back(std::move(start));
    return false;
  }

  Start start_of(const BadPlace& place) const {
    Start start{place.faces, {}, 0, place.crossings, place.bad, place.may_cross};
    for (const Index v : vertices_of(mesh_, place.faces)) {
      start.corners.push_back(mesh_.positions[v]);
      start.on_lines += placement_.is_on_line(v);
    }
    return start;
  }

  /// Of 8,000 slides that were watched to their end, one in six mended its place; of those that
  /// this gives up, one in a hundred would have.
  bool is_in_vain(const BadPlace& place, int sweeps_left) const {
    constexpr std::size_t most_a_sweep = 3;
    const std::size_t most = most_a_sweep * static_cast<std::size_t>(sweeps_left);
    return places_.wrong(place, most + 1) > most;
  }

  /// Lets the vertices of bad faces leave their feature lines, and move over the surface.
  bool leave_lines(const BadPlace& place) {
    bool any = false;
    for (const Index v : place.at_bad) any = (may_be_let_go(v) && placement_.release(v)) || any;
    return any && slide(place);
  }

  /// Who may leave the surface; `free_and_at_bad`: ends too, and the lines only beside bad faces.
  enum class Who { free, free_and_ends, free_and_at_bad };

  bool may_leave(const BadPlace& place, Index v, Who who) const {
    if (placement_.is_free(v)) return true;
    if (placement_.is_tethered(v)) return who != Who::free;
    return who == Who::free_and_at_bad && !(options_.corners_stay && placement_.is_fixed(v)) &&
           may_be_let_go(v) && std::ranges::binary_search(place.at_bad, v);
  }

  bool may_be_let_go(Index v) const {
    if (!options_.creases_stay) return true;
    if (on_border_.empty()) {
      on_border_ = mark_ends(border_edges(mesh_, context_), mesh_.positions.size());
    }
    return on_border_[v] != 0;
  }

  /// Off the surface, but not far: each vertex towards its neighbours, until nothing crosses.
  /// Returns whether that came to be.
  bool loosen(const BadPlace& place, Who who) {
    constexpr int steps = 30;
    const float farthest = mean_edge(mesh_, place.faces);
    std::vector<Index> leaving;
    std::vector<std::size_t> where;  // in the place
    for (std::size_t k = 0; k < place.vertices.size(); ++k) {
      if (!may_leave(place, place.vertices[k], who)) continue;
      leaving.push_back(place.vertices[k]);
      where.push_back(k);
    }
    for (int step = 0; step < steps && !places_.is_mended(place); ++step) {
      effort_left_ -= steps_to_look_at(place);
      std::vector<LocalSearch::Place> next;
      for (std::size_t i = 0; i < leaving.size(); ++i) {
        const auto& [start, seed] = place.before[where[i]];
        const Vec3 towards =
            0.5f * (mesh_.positions[leaving[i]] + search_.mean_neighbor(leaving[i]));
        next.push_back({start + shortened(towards - start, farthest), seed});
      }
      search_.put(leaving, next);
    }
    return places_.is_mended(place);
  }

  const Mesh& mesh_;
  Placement& placement_;
  LocalSearch& search_;
  BadPlaces places_;
  SurfaceCrossings surface_crossings_;
  const SmoothOptions& options_;
  bool is_crumpled_ = false;
  std::size_t failed_slides_ = 0;
  std::vector<Start> failed_starts_;  // of slides, with the same demands
  double effort_left_ = 0;
  mutable std::vector<std::uint8_t> on_border_;  // of each vertex, once it is asked for
  const Context& context_;
};

}  // namespace

void mend_places(const Mesh& mesh, const VertexFaces& around, Placement& placement,
                 LocalSearch& search, const SmoothOptions& options, const Context& context) {
  Mending(mesh, around, placement, search, options, context).run();
}

}  // namespace meshgrain
