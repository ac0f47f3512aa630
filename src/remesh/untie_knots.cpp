#include "remesh/untie_knots.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "extract/collect_faces.h"
#include "extract/drop_unused.h"
#include "extract/extraction_map.h"
#include "extract/face_repair.h"
#include "extract/knot_search.h"
#include "extract/piece.h"
#include "finish/smooth.h"
#include "measure/face_shape.h"
#include "mesh/border.h"
#include "meshgrain/surface.h"
#include "remesh/change_piece.h"
#include "util/triangle.h"

namespace meshgrain {
namespace {

constexpr int iterations = 16;              // of smoothing a piece
constexpr std::size_t least_irregular = 3;  // vertices of a knot
constexpr std::size_t least_cancelled = 2;  // of them
constexpr int most_rings = 7;               // of a piece
constexpr std::size_t largest_piece = 300;  // faces

class Untier {
 public:
  Untier(Extraction& whole, const Mesh& surface, const VertexFaces& around_surface,
         const Graph& graph, SmoothOptions smoothing, float most_worse, const Context& context)
      : whole_(whole),
        surface_(surface),
        around_surface_(around_surface),
        graph_(graph),
        smoothing_(std::move(smoothing)),
        most_worse_(most_worse),
        context_(context) {
    smoothing_.iterations = iterations;
    smoothing_.is_part = true;
    smoothing_.mends_places = false;  // what would need it is not kept
    smoothing_.creases_stay = smoothing_.corners_stay = true;
  }

  void run(std::size_t most) {
    const std::size_t count = whole_.mesh.faces.size();
    constexpr int rounds = 4;
    bool any = false;
    for (int round = 0; round < rounds; ++round) {
      if (!untie_all(most - (count - whole_.mesh.faces.size()))) break;
      any = true;
    }
    if (any) drop_unused(whole_);
  }

 private:
  using Knot = std::vector<Index>;  // vertices

  /// What a piece becomes.
  struct Untied {
    Extraction extraction;
    std::vector<Index> sources;  // see put_back()
  };

  /// Those that were not tried yet and lie apart from each other. Returns whether any could be.
  bool untie_all(std::size_t most) {
    const std::vector<Piece> pieces = pieces_apart();
    std::vector<std::optional<Untied>> untied(pieces.size());
    context_.for_ranges(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) untied[k] = untie(pieces[k], most);
    });
    const std::size_t count = whole_.mesh.faces.size();
    std::vector<Index> gone;  // faces of the mesh that the pieces were cut from
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      if (!untied[k]) continue;
      const auto& [changed, sources] = *untied[k];
      const std::size_t fewer = pieces[k].faces.size() - changed.mesh.faces.size();
      if (count - whole_.mesh.faces.size() + fewer > most) continue;
      Piece piece = pieces[k];
      for (Index& f : piece.faces) {
        f -= static_cast<Index>(std::ranges::lower_bound(gone, f) - gone.begin());
      }
      if (!keep_if_apart(whole_, piece, changed, sources, context_)) continue;
      gone.insert(gone.end(), pieces[k].faces.begin(), pieces[k].faces.end());
      std::ranges::sort(gone);
    }
    return !gone.empty();
  }

  /// Around knots that were not tried yet: no vertex is in two of them.
  std::vector<Piece> pieces_apart() {
    const VertexFaces around = vertex_faces(whole_.mesh, context_);
    find_excess(around);
    std::vector<std::uint8_t> taken(whole_.mesh.positions.size(), 0);
    std::vector<Piece> pieces;
    for (const Knot& knot : knots(around)) {
      std::vector<float> places = places_of(knot);
      if (seen_.contains(places)) continue;
      std::optional<Piece> piece = piece_around(knot, around);
      if (piece && std::ranges::any_of(piece->vertices, [&](Index v) { return taken[v] != 0; })) {
        continue;  // next time
      }
      seen_.insert(std::move(places));
      if (!piece) continue;
      for (const Index v : piece->vertices) taken[v] = 1;
      pieces.push_back(std::move(*piece));
    }
    return pieces;
  }

  /// How many edges each vertex has too many. On the border and where creases meet, other numbers
  /// may well be right.
  void find_excess(const VertexFaces& around) {
    excess_.assign(whole_.mesh.positions.size(), 0);
    for (Index v = 0; v < excess_.size(); ++v) {
      if (!around[v].empty()) excess_[v] = static_cast<int>(around[v].size()) - 4;
    }
    for (const auto& [a, b] : rim_edges(whole_.mesh, context_)) excess_[a] = excess_[b] = 0;
    for (const Index v : whole_.corners) excess_[v] = 0;
  }

  /// Irregular vertices within two edges of each other, if most of them cancel each other out.
  std::vector<Knot> knots(const VertexFaces& around) const {
    std::vector<Knot> result;
    std::vector<std::uint8_t> reached(excess_.size(), 0);
    for (Index start = 0; start < excess_.size(); ++start) {
      if (excess_[start] == 0 || reached[start]) continue;
      Knot knot{start};
      reached[start] = 1;
      int sum = 0;
      for (std::size_t k = 0; k < knot.size(); ++k) {
        sum += excess_[knot[k]];
        for (const Index f : around[knot[k]]) {
          for (const Index w : std::as_const(whole_.mesh.faces)[f]) reach(w, around, reached, knot);
        }
      }
      const auto left = static_cast<std::size_t>(std::abs(sum));
      if (knot.size() >= least_irregular && knot.size() >= left + least_cancelled) {
        result.push_back(std::move(knot));
      }
    }
    return result;
  }

  /// The irregular vertices in the faces around w.
  void reach(Index w, const VertexFaces& around, std::vector<std::uint8_t>& reached,
             Knot& knot) const {
    for (const Index f : around[w]) {
      for (const Index v : std::as_const(whole_.mesh.faces)[f]) {
        if (excess_[v] == 0 || std::exchange(reached[v], std::uint8_t{1})) continue;
        knot.push_back(v);
      }
    }
  }

  /// By which a knot is known again: vertices are numbered anew where something changes.
  std::vector<float> places_of(const Knot& knot) const {
    std::vector<float> result;
    for (const Index v : knot) {
      const Vec3& p = whole_.mesh.positions[v];
      result.insert(result.end(), p.data(), p.data() + 3);
    }
    return result;
  }

  /// Nothing if that is not possible without harm.
  std::optional<Untied> untie(const Piece& piece, std::size_t most) const {
    const ExtractionMap map(piece.extraction, context_);
    if (!is_manifold(piece, map)) return std::nullopt;
    std::vector<int> excess;
    for (const Index v : map.sources) excess.push_back(excess_[piece.vertices[v]]);
    for (const Untying& way : search_knot(map, excess, most, context_)) {
      ExtractionMap parts = map;
      FaceRepair repair(parts.map, parts.clusters, 4, std::move(parts.holes),
                        std::move(parts.lines));
      take_steps(repair, way.steps);
      std::vector<Index> vertex;
      Extraction changed = collect_faces(parts.map, repair, parts.clusters, vertex, context_);
      smooth(changed, surface_, around_surface_, graph_, smoothing_, context_);
      if (!is_as_good(changed, piece.extraction)) continue;
      keep_to_own_side(changed, surface_, around_surface_, graph_, smoothing_, context_);
      if (!is_as_good(changed, piece.extraction)) continue;
      auto sources = rim_sources(piece, map, vertex, changed.mesh.positions.size());
      return Untied{std::move(changed), std::move(sources)};
    }
    return std::nullopt;
  }

  /// With two rings of faces around the knot, to make room.
  std::optional<Piece> piece_around(const Knot& knot, const VertexFaces& around) const {
    const auto& positions = whole_.mesh.positions;
    Vec3 middle = Vec3::Zero();
    for (const Index v : knot) middle += positions[v] / static_cast<float>(knot.size());
    const Index center = *std::ranges::min_element(
        knot, {}, [&](Index v) { return (positions[v] - middle).squaredNorm(); });
    const Index face = around[center][0];
    std::vector<Index> inside{face};
    int rings = 0;
    const auto holds = [&](Index v) { return std::ranges::includes(inside, around[v]); };
    while (!std::ranges::all_of(knot, holds)) {
      if (++rings > most_rings || inside.size() > largest_piece) return std::nullopt;
      inside = with_rings(whole_.mesh, around, inside, 1);
    }
    return cut_piece(whole_, around, face, rings + 2);
  }

  bool is_as_good(const Extraction& changed, const Extraction& old) const {
    constexpr float good = 0.5f;          // a scaled Jacobian
    constexpr float hardly_any = 0.002f;  // of what lean() says
    constexpr double far = 0.6;           // sides: else the end of a limb might go
    if (lack(changed.mesh) > most_worse_ * lack(old.mesh)) return false;
    if (least_jacobian(changed.mesh) < std::min(least_jacobian(old.mesh), good)) return false;
    if (lean(changed) > 1.05f * lean(old) + hardly_any) return false;
    const double side =
        std::sqrt(surface_area(old.mesh) / static_cast<double>(old.mesh.faces.size()));
    return farthest(old.mesh, changed.mesh) <= far * side;
  }

  /// The distance of the vertex of one mesh that is farthest from the other.
  static float farthest(const Mesh& from, const Mesh& to) {
    float most = 0;
    for (const Vec3& p : from.positions) {
      float nearest = std::numeric_limits<float>::infinity();
      for (std::size_t f = 0; f < to.faces.size() && nearest > most * most; ++f) {
        const auto face = to.faces[f];
        for (std::size_t k = 2; k < face.size(); ++k) {
          const Vec3 q = closest_point_on_triangle(
              p, to.positions[face[0]], to.positions[face[k - 1]], to.positions[face[k]]);
          nearest = std::min(nearest, (p - q).squaredNorm());
        }
      }
      most = std::max(most, std::sqrt(nearest));
    }
    return most;
  }

  /// How far the faces look elsewhere than the surface does at their corners, in the mean.
  float lean(const Extraction& part) const {
    float sum = 0, count = 0;
    for (std::size_t f = 0; f < part.mesh.faces.size(); ++f) {
      const auto face = std::as_const(part.mesh.faces)[f];
      const Vec3 normal = area_vector(face, part.mesh.positions).stableNormalized();
      for (const Index v : face) sum += 1 - normal.dot(graph_.normals[part.nodes[v]]);
      count += static_cast<float>(face.size());
    }
    return sum / count;
  }

  /// How askew and uneven the faces are, in the mean.
  static float lack(const Mesh& mesh) {
    constexpr float for_unevenness = 0.2f;
    std::vector<float> areas;
    float sum = 0, whole = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const float askew = 1 - scaled_jacobian(mesh.faces[f], mesh.positions);
      sum += askew * askew;
      areas.push_back(area_vector(mesh.faces[f], mesh.positions).norm());
      whole += areas.back();
    }
    const auto count = static_cast<float>(areas.size());
    for (const float area : areas) {
      const float uneven = std::log(std::max(area * count / whole, 1e-3f));
      sum += for_unevenness * uneven * uneven;
    }
    return sum / count;
  }

  Extraction& whole_;
  const Mesh& surface_;
  const VertexFaces& around_surface_;
  const Graph& graph_;
  SmoothOptions smoothing_;
  const float most_worse_;
  const Context& context_;
  std::vector<int> excess_;  // of each vertex
  std::set<std::vector<float>> seen_;
};

}  // namespace

void untie_knots(Extraction& extraction, const Mesh& surface, const VertexFaces& around_surface,
                 const Graph& graph, SmoothOptions smoothing, std::size_t most, float most_worse,
                 const Context& context) {
  const Faces& faces = extraction.mesh.faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces.degree(f) != 4) return;
  }
  Untier(extraction, surface, around_surface, graph, std::move(smoothing), most_worse, context)
      .run(most);
}

}  // namespace meshgrain
