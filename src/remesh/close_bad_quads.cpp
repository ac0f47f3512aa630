#include "remesh/close_bad_quads.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "extract/collect_faces.h"
#include "extract/drop_unused.h"
#include "extract/extraction_map.h"
#include "extract/face_repair.h"
#include "extract/piece.h"
#include "finish/smooth.h"
#include "measure/crossings.h"
#include "measure/face_shape.h"
#include "remesh/change_piece.h"

namespace meshgrain {
namespace {

constexpr float good = 0.1f;    // a scaled Jacobian
constexpr int iterations = 12;  // of smoothing a piece
// How large the pieces are, in rings of faces around the bad one, and in how many ways it is mended
// there.
constexpr struct {
  int rings;
  std::size_t ways;
} pieces[] = {{4, 6}, {3, 2}, {5, 2}};
// What is tried in all, and once more for so many faces.
constexpr std::size_t tries = 10, faces_a_try = 4000;

class Closing {
 public:
  Closing(Extraction& whole, const Mesh& surface, const VertexFaces& around_surface,
          const Graph& graph, SmoothOptions smoothing, const Context& context)
      : whole_(whole),
        surface_(surface),
        around_surface_(around_surface),
        graph_(graph),
        smoothing_(std::move(smoothing)),
        corners_stay_(smoothing_.corners_stay),
        context_(context) {
    smoothing_.iterations = iterations;
    smoothing_.is_part = true;
    smoothing_.creases_stay = smoothing_.corners_stay = true;
  }

  void run(std::size_t most) {
    const std::size_t count = whole_.mesh.faces.size(), bad = bad_quads().size();
    constexpr std::size_t hopeless = 5;  // one in so many
    if (bad == 0 || bad > count / hopeless) return;
    const auto gone = [&] { return count - whole_.mesh.faces.size(); };
    is_crumpled_ = is_crumpled(find_crossings(whole_.mesh, context_).size(), count);
    tries_left_ = worth(tries + count / faces_a_try);
    while (gone() < most && close_one(most - gone())) {
    }
    let_lines_go();
    if (any_changed_) drop_unused(whole_);
  }

 private:
  using Corners = std::array<Index, 4>;

  std::size_t worth(std::size_t all) const {
    return is_crumpled_ ? static_cast<std::size_t>(effort_if_crumpled * static_cast<double>(all))
                        : all;
  }

  Corners corners(Index f) const {
    const auto face = std::as_const(whole_.mesh.faces)[f];
    return {face[0], face[1], face[2], face[3]};
  }

  /// Those that were not tried yet, the worst first.
  std::vector<Index> bad_quads() const {
    std::vector<std::pair<float, Index>> found;
    const Faces& faces = whole_.mesh.faces;
    for (Index f = 0; f < faces.size(); ++f) {
      if (faces.degree(f) != 4) continue;
      const float quality = scaled_jacobian(faces[f], whole_.mesh.positions);
      if (quality < good && !seen_.contains(corners(f))) found.push_back({quality, f});
    }
    std::ranges::sort(found);
    std::vector<Index> result;
    for (const auto& [quality, f] : found) result.push_back(f);
    return result;
  }

  /// Closes the worst quad that can be. Returns whether there was one.
  bool close_one(std::size_t most) {
    const std::vector<Index> bad = bad_quads();
    if (bad.empty()) return false;
    const VertexFaces around = vertex_faces(whole_.mesh, context_);
    for (const Index f : bad) {
      seen_.insert(corners(f));
      for (const auto& [rings, ways] : pieces) {
        if (close(cut_piece(whole_, around, f, rings), ways, most)) return true;
        if (tries_left_ == 0) return false;
      }
    }
    return false;
  }

  /// Where nothing else helps, vertices may leave the lines and corners that hold them.
  void let_lines_go() {
    smoothing_.creases_stay = false;
    smoothing_.corners_stay = corners_stay_;
    tries_left_ = worth(tries);
    seen_.clear();
    while (let_go_at_one()) {
    }
  }

  /// At the worst quad where it helps. Returns whether there was one.
  bool let_go_at_one() {
    const std::vector<Index> bad = bad_quads();
    if (bad.empty()) return false;
    const VertexFaces around = vertex_faces(whole_.mesh, context_);
    for (const Index f : bad) {
      if (tries_left_ == 0) return false;
      --tries_left_;
      seen_.insert(corners(f));
      for (const auto& [rings, ways] : pieces) {
        if (let_go_in(cut_piece(whole_, around, f, rings))) return true;
      }
    }
    return false;
  }

  bool let_go_in(const Piece& piece) {
    Extraction changed = piece.extraction;
    mend(changed, surface_, around_surface_, graph_, smoothing_, context_);
    if (lack(changed) >= lack(piece.extraction)) return false;
    std::vector<Index> sources(changed.mesh.positions.size(), no_index);
    for (Index v = 0; v < sources.size(); ++v) {
      if (piece.on_rim[v]) sources[v] = v;
    }
    return keep(piece, changed, sources);
  }

  bool keep(const Piece& piece, const Extraction& changed, const std::vector<Index>& sources) {
    const bool kept = keep_if_apart(whole_, piece, changed, sources, context_);
    any_changed_ = any_changed_ || kept;
    return kept;
  }

  /// How much is wrong with the faces of a piece.
  float lack(const Extraction& part) const {
    constexpr float inverted = 10, turned_over = 1;  // away from the surface
    const Mesh& mesh = part.mesh;
    float sum = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto face = mesh.faces[f];
      Vec3 upward = Vec3::Zero();
      for (const Index v : face) upward += graph_.normals[part.nodes[v]];
      if (area_vector(face, mesh.positions).dot(upward) < 0) sum += turned_over;
      if (face.size() != 4) continue;
      const float quality = scaled_jacobian(face, mesh.positions);
      if (quality <= 0) sum += inverted;
      sum += std::max(0.0f, good - quality);
    }
    return sum;
  }

  /// The least sine of the corners of a quad at vertices that cannot move freely.
  static float sine_where_held(const Corners& quad, const Clusters& clusters) {
    const auto& positions = clusters.positions;
    const Vec3 normal = area_vector(quad, positions).normalized();
    float least = 1;
    for (std::size_t k = 0; k < 4; ++k) {
      const Index v = quad[k];
      if (clusters.hold[v] == free_vertex && !clusters.on_border[v]) continue;
      const Vec3 ahead = (positions[quad[(k + 1) % 4]] - positions[v]).normalized();
      const Vec3 back = (positions[quad[(k + 3) % 4]] - positions[v]).normalized();
      least = std::min(least, normal.dot(ahead.cross(back)));
    }
    return least;
  }

  /// The ways to turn an edge of a face, the best first, that leave quads which smoothing may mend.
  static std::vector<FaceRepair::EdgeChange> good_turns(const FaceRepair& repair, Index face,
                                                        const Clusters& clusters) {
    constexpr float hardly_reflex = -0.5f;
    constexpr std::size_t most = 2;
    std::vector<FaceRepair::EdgeChange> ways;
    for (FaceRepair::EdgeChange way : repair.ways_to_turn(face)) {
      float least = 1, held = 1;
      for (const Corners& quad : repair.turned(way)) {
        least = std::min(least, scaled_jacobian(quad, clusters.positions));
        held = std::min(held, sine_where_held(quad, clusters));
      }
      if (least < hardly_reflex || held < good) continue;
      way.cost = -least;
      ways.push_back(way);
    }
    std::ranges::stable_sort(ways, {}, &FaceRepair::EdgeChange::cost);
    if (ways.size() > most) ways.resize(most);
    return ways;
  }

  /// Closes the first face of a piece in the first of some ways that leaves less wrong with it.
  /// Returns whether there is one.
  bool close(const Piece& piece, std::size_t ways, std::size_t most) {
    const ExtractionMap map(piece.extraction, context_);
    if (!is_manifold(piece, map)) return false;
    // The face's first corner is the first of all.
    const auto first = std::ranges::find(map.corners, Index{0}) - map.corners.begin();
    const float before = lack(piece.extraction);
    for (std::size_t way = 0; way < ways && tries_left_ > 0; ++way) {
      context_.check();
      ExtractionMap parts = map;
      FaceRepair repair(parts.map, parts.clusters, 4, std::move(parts.holes),
                        std::move(parts.lines));
      // No face goes where it is enough to turn an edge, as at a straight angle of a crease.
      const auto turns = good_turns(repair, static_cast<Index>(first), parts.clusters);
      if (way < turns.size()) {
        repair.apply(turns[way]);
      } else {
        const std::vector<Index> all = repair.ways_to_close(static_cast<Index>(first));
        if (way - turns.size() >= all.size()) return false;
        repair.close_quad(all[way - turns.size()]);
      }
      repair.remove_doublets();
      std::vector<Index> vertex;
      Extraction changed = collect_faces(parts.map, repair, parts.clusters, vertex, context_);
      if (piece.faces.size() - changed.mesh.faces.size() > most) continue;
      --tries_left_;
      smooth(changed, surface_, around_surface_, graph_, smoothing_, context_);
      if (lack(changed) >= before) continue;

      const auto sources = rim_sources(piece, map, vertex, changed.mesh.positions.size());
      if (keep(piece, changed, sources)) return true;
    }
    return false;
  }

  Extraction& whole_;
  const Mesh& surface_;
  const VertexFaces& around_surface_;
  const Graph& graph_;
  SmoothOptions smoothing_;
  const bool corners_stay_;  // in the end, too
  const Context& context_;
  bool is_crumpled_ = false;
  std::size_t tries_left_ = 0;
  bool any_changed_ = false;
  std::set<Corners> seen_;
};

}  // namespace

void close_bad_quads(Extraction& extraction, const Mesh& surface, const VertexFaces& around_surface,
                     const Graph& graph, SmoothOptions smoothing, std::size_t most,
                     const Context& context) {
  Closing(extraction, surface, around_surface, graph, std::move(smoothing), context).run(most);
}

}  // namespace meshgrain
