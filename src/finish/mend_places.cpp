#include "finish/mend_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "finish/crossings.h"
#include "finish/face_shape.h"
#include "mesh/border.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

class Mending {
 public:
  Mending(const Mesh& mesh, const VertexFaces& around, Placement& placement, LocalSearch& search,
          const SmoothOptions& options, const Context& context)
      : mesh_(mesh),
        around_(around),
        placement_(placement),
        search_(search),
        options_(options),
        context_(context) {}

  void run() {
    if (!options_.is_part) part_crossings();
    failed_slides_ = 0;
    effort_left_ = 0;
    for (const Demands& demands : ever_less) {
      demands_ = demands;
      effort_left_ += effort();
      for (const int rings : ever_wider) reshape_all(rings);
    }
  }

 private:
  /// Two bad faces with some rings of others, how they are, and what may stay bad among them.
  struct Place {
    std::vector<Index> faces;
    std::vector<Index> vertices;  // those with all of their faces in it
    std::vector<LocalSearch::Place> before;
    std::vector<Index> at_bad;  // those of them that belong to bad faces, see is_bad()
    std::size_t crossings = 0;  // pairs of faces that pass through each other
    std::size_t bad = 0;        // faces
    std::size_t poor = 0;       // faces, see not_poor
    bool may_cross = false;     // as the surface itself does
  };

  /// What makes a face acceptable.
  struct Demands {
    bool along_surface;  // it looks where the surface does; else only where its neighbours do
    float quality;
  };

  // Across a fold that is narrower than a face, faces cannot look where the surface does there.
  static constexpr Demands ever_less[] = {{true, 0.1f}, {false, 0.1f}, {false, 0}};
  static constexpr int ever_wider[] = {2, 3, 5};  // rings of faces around the bad ones

  // A face must not be mended by drawing a thin finger into a string.
  static constexpr Demands not_poor = {false, 0.3f};
  static constexpr std::size_t most_spoiled = 2;       // faces that become poor
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
  static constexpr std::size_t tries = 6, tries_to_reshape = 8;
  static constexpr std::size_t most_searched = 20000;  // faces of the surface in a place
  static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();

  /// To look at a place once. Large ones, where a mesh is crumpled, have few faces that are not
  /// compared with each other.
  static double steps_to_look_at(const Place& place) {
    constexpr double large = 150;
    const auto faces = static_cast<double>(place.faces.size());
    return faces * std::max(1.0, std::pow(faces / large, 2));
  }

  double effort() const {
    return options_.is_part
               ? effort_for_a_part
               : effort_for_a_mesh + effort_a_face * static_cast<double>(mesh_.faces.size());
  }

  void part_crossings() {
    std::vector<std::uint8_t> inherent(mesh_.faces.size(), 0);  // beside crossings of the surface
    for (const Demands& demands : ever_less) {
      demands_ = demands;
      effort_left_ += effort();
      bool few = true;
      for (const int rings : ever_wider) {
        const auto crossings = find_crossings(mesh_, context_);
        if (crossings.empty()) return;
        few = part_all(crossings, rings, inherent) && few;
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
      Place place = around(f, g, rings);
      effort_left_ -= steps_to_look_at(place);
      if (is_hopeless(place) || surface_crosses(place)) {
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
      if (failed[f] >= tries_to_reshape || !is_bad(f)) continue;
      if (++tried > std::max(most_tried, mesh_.faces.size() / 100) || effort_left_ <= 0) break;
      Place place = around(f, f, rings);
      effort_left_ -= steps_to_look_at(place);
      if (is_hopeless(place)) {
        for (const Index h : place.faces) ++failed[h];
        continue;
      }
      --place.bad;
      // What could not be parted must not keep faces turned inside out as well.
      const bool is_last = demands_.quality <= 0;
      place.may_cross =
          place.crossings > 0 && !options_.is_part && (is_last || surface_crosses(place));
      if (reshape(place)) continue;
      restore(place);
      for (const Index h : place.faces) ++failed[h];
    }
  }

  bool falls_short(Index f, const Demands& demands) const {
    return search_.quality(f) < demands.quality &&
           (demands.along_surface || search_.quality_among_neighbors(f) < demands.quality);
  }
  bool is_bad(Index f) const { return falls_short(f, demands_); }

  /// Here and below: no more are counted than `limit`.
  std::size_t count_short(const Place& place, const Demands& demands, std::size_t limit) const {
    std::size_t count = 0;
    for (std::size_t k = 0; k < place.faces.size() && count < limit; ++k) {
      count += falls_short(place.faces[k], demands);
    }
    return count;
  }

  Place around(Index f, Index g, int rings) const {
    context_.check();
    Place place;
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

  /// That anything can be done about.
  static std::size_t most_crossings(const Place& place) {
    return hopeless_crossings * place.faces.size();
  }
  bool is_hopeless(const Place& place) const { return place.crossings >= most_crossings(place); }

  std::size_t count_crossings(const Place& place, std::size_t limit) const {
    std::vector<Eigen::AlignedBox3f> boxes;
    for (const Index f : place.faces) boxes.push_back(face_box(mesh_, f));
    std::size_t count = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t j = i + 1; j < boxes.size() && count < limit; ++j) {
        count +=
            boxes[i].intersects(boxes[j]) && penetration(mesh_, place.faces[i], place.faces[j]) > 0;
      }
    }
    return count;
  }

  bool is_mended(const Place& place) const {
    const std::size_t may_be_poor = place.poor + most_spoiled;
    return count_short(place, demands_, place.bad + 1) <= place.bad &&
           count_short(place, not_poor, may_be_poor + 1) <= may_be_poor &&
           (place.may_cross || count_crossings(place, place.crossings + 1) <= place.crossings);
  }

  bool may_slide(const Place& place) const {
    return place.faces.size() <= largest_to_slide &&
           (place.may_cross || place.crossings <= most_crossings_to_slide) &&
           failed_slides_ < (options_.is_part
                                 ? 1
                                 : most_failed_slides + mesh_.faces.size() / faces_a_failed_slide);
  }

  bool part(const Place& place) {
    if (may_slide(place)) {
      if (slide(place)) return true;
      restore(place);
    }
    if (loosen(place, Who::free) || (may_slide(place) && slide(place))) return true;
    restore(place);
    return loosen(place, Who::free_and_ends);
  }

  /// Ends that are held go before features do.
  bool reshape(const Place& place) {
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
  bool surface_crosses(const Place& place) const {
    std::vector<Index> nodes;
    Eigen::AlignedBox3f box;
    for (const LocalSearch::Place& at : place.before) {
      nodes.push_back(placement_.node(at.seed));
      box.extend(at.position);
    }
    const auto piece = placement_.projector().cut_out(box, std::move(nodes), most_searched);
    return !piece || !find_crossings(*piece, context_).empty();
  }

  void restore(const Place& place) { search_.put(place.vertices, place.before); }

  /// Over the surface. Returns whether the place is mended.
  bool slide(const Place& place) {
    effort_left_ -= effort_to_slide_a_face * static_cast<double>(place.faces.size());
    search_.keep_apart(place.may_cross ? std::vector<Index>() : place.faces);
    for (const Index v : place.vertices) search_.touch(v);
    constexpr int sweeps = 5;
    search_.improve(place.vertices, sweeps, context_);
    search_.keep_apart({});
    const bool mended = is_mended(place);
    if (!mended) ++failed_slides_;
    return mended;
  }

  /// Lets the vertices of bad faces leave their feature lines, and move over the surface.
  bool leave_lines(const Place& place) {
    bool any = false;
    for (const Index v : place.at_bad) any = (may_be_let_go(v) && placement_.release(v)) || any;
    return any && slide(place);
  }

  /// Who may leave the surface; `free_and_at_bad`: ends too, and the lines only beside bad faces.
  enum class Who { free, free_and_ends, free_and_at_bad };

  bool may_leave(const Place& place, Index v, Who who) const {
    if (placement_.is_free(v)) return true;
    if (placement_.is_tethered(v)) return who != Who::free;
    return who == Who::free_and_at_bad && !(options_.corners_stay && placement_.is_fixed(v)) &&
           may_be_let_go(v) && std::ranges::binary_search(place.at_bad, v);
  }

  bool may_be_let_go(Index v) const {
    if (!options_.creases_stay) return true;
    if (on_border_.empty()) {
      on_border_.assign(mesh_.positions.size(), 0);
      for (const auto& [a, b] : border_edges(mesh_, context_)) on_border_[a] = on_border_[b] = 1;
    }
    return on_border_[v] != 0;
  }

  /// Off the surface, but not far: each vertex towards its neighbours, until nothing crosses.
  /// Returns whether that came to be.
  bool loosen(const Place& place, Who who) {
    constexpr int steps = 30;
    const float farthest = mean_edge(mesh_, place.faces);
    std::vector<Index> leaving;
    std::vector<std::size_t> where;  // in the place
    for (std::size_t k = 0; k < place.vertices.size(); ++k) {
      if (!may_leave(place, place.vertices[k], who)) continue;
      leaving.push_back(place.vertices[k]);
      where.push_back(k);
    }
    for (int step = 0; step < steps && !is_mended(place); ++step) {
      effort_left_ -= steps_to_look_at(place);
      std::vector<LocalSearch::Place> next;
      for (std::size_t i = 0; i < leaving.size(); ++i) {
        const auto& [start, seed] = place.before[where[i]];
        const Vec3 towards =
            0.5f * (mesh_.positions[leaving[i]] + search_.mean_neighbor(leaving[i]));
        const Vec3 moved = towards - start;
        next.push_back(
            {start + moved * std::min(1.0f, farthest / std::max(moved.norm(), 1e-30f)), seed});
      }
      search_.put(leaving, next);
    }
    return is_mended(place);
  }

  const Mesh& mesh_;
  const VertexFaces& around_;
  Placement& placement_;
  LocalSearch& search_;
  const SmoothOptions& options_;
  Demands demands_ = ever_less[0];
  std::size_t failed_slides_ = 0;
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
