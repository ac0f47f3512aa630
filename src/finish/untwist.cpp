#include "finish/untwist.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "finish/turned_over.h"
#include "measure/crossings.h"
#include "measure/face_shape.h"
#include "mesh/border.h"
#include "mesh/vertex_faces.h"
#include "util/indices.h"
#include "util/shortened.h"

namespace meshgrain {
namespace {

class Untwisting {
 public:
  Untwisting(Extraction& extraction, const std::vector<Vec3>& node_normals, bool border_stays,
             const Context& context)
      : extraction_(extraction),
        mesh_(extraction.mesh),
        node_normals_(node_normals),
        border_stays_(border_stays),
        context_(context) {}

  void run() {
    // Most meshes have none, and need not know which faces are neighbours.
    const auto may_be_twisted = [&](Index f) {
      return has_bad_corner(f) || looks_away(extraction_, f, node_normals_);
    };
    if (indices_where(mesh_.faces.size(), may_be_twisted, context_).empty()) return;
    around_ = vertex_faces(mesh_, context_);
    std::vector<Index> twisted = twisted_faces();
    const std::size_t faces = mesh_.faces.size();
    constexpr std::size_t hopeless = 5;  // one in so many
    if (twisted.empty() || twisted.size() > faces / hopeless) return;
    const std::size_t crossings = find_crossings(mesh_, context_).size();
    if (crossings > hopeless_crossings * faces) return;
    start_ = mesh_.positions;
    hold();
    const double effort = is_crumpled(crossings, faces) ? effort_if_crumpled : 1;
    tries_left_ = static_cast<std::size_t>(
        effort * static_cast<double>(tries_for_a_mesh + tries_a_face * faces));
    for (const Price& price : ever_dearer) {
      if (price.leaves == on_border && border_stays_) continue;
      good_ = price.good;
      for (const int rings : {2, 3, 5}) {
        // A mesh with more of them is too coarse for its surface: no need to try for minutes.
        const std::size_t most = 50 + faces / 100;
        twisted.resize(std::min(twisted.size(), most));
        for (const Index f : twisted) mend(f, rings, price);
        twisted = twisted_faces();
        if (twisted.empty()) return;
      }
    }
  }

 private:
  /// What a vertex is held by.
  enum Stay : std::uint8_t { nowhere, on_line, at_corner, on_border };

  struct Price {
    Stay leaves;            // who may move: those that no more than this holds
    std::size_t crossings;  // how many more may come of each quad that is mended
    float good;             // what the faces around it should be worth
    bool is_relaxed;        // whether vertices start amid their neighbours
  };
  static constexpr Price ever_dearer[] = {
      {nowhere, 0, 0.2f, false},       {on_line, 10, 0.2f, false},
      {on_line, 1000, 0.2f, false},    {nowhere, 1000, 0.03f, true},
      {at_corner, 1000, 0.03f, false}, {at_corner, 1000, 0.03f, true},
      {on_border, 1000, 0.03f, false},
  };
  /// Of vertices: twice as many as were ever needed to untwist all, which takes seconds.
  static constexpr std::size_t tries_for_a_mesh = 300000, tries_a_face = 10;

  void hold() {
    stays_.assign(mesh_.positions.size(), nowhere);
    for (const LineEdge& edge : extraction_.line_edges) stays_[edge.a] = stays_[edge.b] = on_line;
    for (const Index v : extraction_.corners) stays_[v] = at_corner;
    for (const auto& [a, b] : border_edges(mesh_, context_)) stays_[a] = stays_[b] = on_border;
  }

  std::span<const Index> face(Index f) const { return std::as_const(mesh_.faces)[f]; }

  bool has_bad_corner(Index f) const {
    constexpr float rounding = 1e-3f;  // of what is written
    return mesh_.faces.degree(f) == 4 && scaled_jacobian(face(f), mesh_.positions) <= rounding;
  }

  bool is_twisted(Index f) const {
    return has_bad_corner(f) || is_turned_over(extraction_, f, around_, node_normals_);
  }

  std::vector<Index> twisted_faces() const {
    return indices_where(
        mesh_.faces.size(), [&](Index f) { return is_twisted(f); }, context_);
  }

  /// What a face is worth if either the surface or its neighbours say which side is up; from
  /// `enough` on it need not be exact.
  float quality(Index f, float enough) const {
    const Vec3 area = area_vector(face(f), mesh_.positions);
    Vec3 of_surface = Vec3::Zero();
    for (const Index v : face(f)) of_surface += node_normals_[extraction_.nodes[v]];
    const float by_surface = face_quality(face(f), mesh_.positions, area, of_surface.normalized());
    if (by_surface >= enough) return by_surface;
    const Vec3 of_neighbors = area_around(mesh_, f, around_).normalized();
    return std::max(by_surface, face_quality(face(f), mesh_.positions, area, of_neighbors));
  }

  /// Of the faces around a vertex; from `limit` on it need not be exact.
  float lack(Index v, float limit) const {
    float sum = 0;
    for (const Index f : around_[v]) {
      const float bad = std::max(0.0f, good_ - quality(f, good_));
      sum += bad * bad;
      if (sum >= limit) break;
    }
    return sum;
  }

  struct Place {
    std::vector<Index> faces;
    std::vector<Index> vertices;  // those that may move
    std::vector<Vec3> before;
    float edge = 0;  // mean length
  };

  Place around(Index f, int rings, const Price& price) const {
    Place place;
    place.faces = with_rings(mesh_, around_, {f}, rings);
    place.edge = mean_edge(mesh_, place.faces);
    for (const Index v : vertices_of(mesh_, place.faces)) {
      const bool is_inside = std::ranges::includes(place.faces, around_[v]);
      if (is_inside && stays_[v] <= price.leaves) place.vertices.push_back(v);
    }
    for (const Index v : place.vertices) place.before.push_back(mesh_.positions[v]);
    return place;
  }

  std::size_t count_twisted(const Place& place) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(place.faces, [&](Index f) { return is_twisted(f); }));
  }

  void mend(Index f, int rings, const Price& price) {
    context_.check();
    if (tries_left_ == 0 || !is_twisted(f)) return;
    const Place place = around(f, rings, price);
    if (boxes_.empty()) boxes_ = face_boxes(mesh_, context_);
    const std::size_t crossings = count_crossings_of(mesh_, place.faces, boxes_, context_);
    const std::size_t twisted = count_twisted(place);
    if (price.is_relaxed) relax(place);
    move(place);
    const std::size_t left = count_twisted(place);
    if (left < twisted && count_crossings_of(mesh_, place.faces, boxes_, context_) <=
                              crossings + price.crossings * (twisted - left)) {
      for (const Index g : place.faces) boxes_[g] = face_box(mesh_, g);
      return;
    }
    for (std::size_t k = 0; k < place.vertices.size(); ++k) {
      mesh_.positions[place.vertices[k]] = place.before[k];
    }
  }

  /// Each vertex to the mean of its neighbours, again and again: what is folded over unfolds.
  void relax(const Place& place) {
    constexpr int sweeps = 20;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      for (const Index v : place.vertices) {
        Vec3 sum = Vec3::Zero();
        float count = 0;
        for (const Index f : around_[v]) {
          const auto corners = face(f);
          const std::size_t n = corners.size(), k = corner_of(corners, v);
          sum += mesh_.positions[corners[(k + 1) % n]] + mesh_.positions[corners[(k + n - 1) % n]];
          count += 2;
        }
        mesh_.positions[v] = start_[v] + shortened(sum / count - start_[v], place.edge);
      }
    }
  }

  /// Each vertex to where the faces around it are best, by trying places (Hooke and Jeeves 1961).
  void move(const Place& place) {
    constexpr int sweeps = 40;
    constexpr float first_step = 0.25f, last_step = 0.01f;
    float step = first_step * place.edge;
    for (int sweep = 0; sweep < sweeps && step > last_step * place.edge; ++sweep) {
      bool any = false;
      for (const Index v : place.vertices) any = try_around(v, step, place.edge) || any;
      tries_left_ -= std::min(tries_left_, place.vertices.size());
      if (!any) step /= 2;
    }
  }

  bool try_around(Index v, float step, float farthest) {
    Vec3& position = mesh_.positions[v];
    const Vec3 here = position;
    Vec3 best = here;
    float least = lack(v, std::numeric_limits<float>::infinity());
    for (int direction = 0; direction < 27 && least > 0; ++direction) {
      const Vec3 to(static_cast<float>(direction % 3 - 1),
                    static_cast<float>(direction / 3 % 3 - 1),
                    static_cast<float>(direction / 9 - 1));
      position = here + step * to;
      if ((position - start_[v]).norm() > farthest) continue;
      if (const float left = lack(v, least); left < least) {
        least = left;
        best = position;
      }
    }
    position = best;
    return best != here;
  }

  const Extraction& extraction_;
  Mesh& mesh_;
  const std::vector<Vec3>& node_normals_;
  const bool border_stays_;
  const Context& context_;
  VertexFaces around_;
  std::vector<Vec3> start_;  // positions, before all
  std::vector<Stay> stays_;
  float good_ = 0;  // see Price
  std::size_t tries_left_ = 0;
  std::vector<Eigen::AlignedBox3f> boxes_;  // of all faces, as they are between tries
};

}  // namespace

void untwist(Extraction& extraction, const std::vector<Vec3>& node_normals, bool border_stays,
             const Context& context) {
  Untwisting(extraction, node_normals, border_stays, context).run();
}

}  // namespace meshgrain
