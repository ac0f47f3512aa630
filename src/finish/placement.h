#pragma once

#include <span>
#include <vector>

#include "finish/fit_to_rails.h"
#include "finish/go_around.h"
#include "finish/projector.h"
#include "finish/rails.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Where the vertices of a mesh over a surface may go: inner ones anywhere on it, those on feature
/// lines along these, corners nowhere.
class Placement {
 public:
  /// All must outlive this.
  Placement(Extraction& extraction, const Mesh& surface, const VertexFaces& around_surface,
            const Graph& graph, const FeatureLines& lines, const Context& context = Context(1));

  /// The place nearest to `p` that vertex v may have. Remembers in Extraction::nodes where that is,
  /// so that calls for the same vertex must not run at once.
  Vec3 place(const Vec3& p, std::size_t v);

  /// To be called before vertices slide() at once.
  void note_ways(const Context& context) { chords_.note_ways(context); }
  /// The same as place(), but a vertex on a line stays between its neighbours there.
  Vec3 slide(const Vec3& p, std::size_t v);

  /// A plane near which v, if it is free, may take small steps from about `p`.
  Projector::Plane touch(const Vec3& p, std::size_t v) {
    return projector_.touch(p, extraction_.nodes[v]);
  }

  /// To be called before vertices[k], one after the other, look for their planes: those to come
  /// lie far from each other in memory.
  void prefetch(std::span<const Index> vertices, std::size_t k) const {
    constexpr std::size_t soon = 6, later = 12;
    if (k + later < vertices.size()) {
      projector_.prefetch_node(extraction_.nodes[vertices[k + later]]);
    }
    if (k + soon < vertices.size()) {
      projector_.prefetch_neighbors(extraction_.nodes[vertices[k + soon]]);
    }
  }

  bool is_fixed(std::size_t v) const { return rails_.is_fixed(v); }
  bool is_tethered(std::size_t v) const { return tether_[v] != no_index; }
  bool is_on_line(std::size_t v) const { return !rails_.is_free(v); }
  /// Whether it may go anywhere on the surface.
  bool is_free(std::size_t v) const { return rails_.is_free(v) && !is_tethered(v); }

  /// Whether a free vertex may be at a point on the surface or near to it: its tether reaches so
  /// far.
  bool allows(const Vec3& p, std::size_t v) const {
    if (!is_tethered(v)) return true;
    const Tether& tether = tethers_[tether_[v]];
    return (p - tether.end).norm() <= tether.radius;
  }

  /// Moves v to a point of the surface, near a node of it; from then on it stays within `radius` of
  /// `end`, or as near as it then is.
  void tether(std::size_t v, const Vec3& p, Index node, const Vec3& end, float radius);

  /// See the function.
  void go_around(const VertexFaces& around);

  /// Slides vertices along lines to where the edges between them cut off less.
  void fit_lines() { fit_to_rails(extraction_.mesh, chords_, rails_); }

  /// How much the two edges along the line of v cut off of it, see Chords.
  double cut_off(Index v) const { return chords_.cut_off(v); }

  /// Lets v leave the line that holds it. Returns whether there was one.
  bool release(std::size_t v) { return rails_.release(v, extraction_.nodes[v]); }

  /// The normal of the surface where vertex v is; zero where pieces of it meet, which have each
  /// their own.
  Vec3 normal(std::size_t v) const {
    if (rails_.is_meeting(v)) return Vec3::Zero();
    return projector_.normal(extraction_.nodes[v]);
  }

  const Projector& projector() const { return projector_; }

  /// What place() remembers of a vertex, to go back to.
  struct Seed {
    Index node, on_line;
  };
  Seed seed(std::size_t v) const { return {extraction_.nodes[v], rails_.place(v)}; }
  void set_seed(std::size_t v, const Seed& seed) {
    extraction_.nodes[v] = seed.node;
    rails_.set_place(v, seed.on_line);
  }
  /// A vertex of the surface near that place.
  Index node(const Seed& seed) const {
    const Index on_line = rails_.node(seed.on_line);
    return on_line != no_index ? on_line : seed.node;
  }

 private:
  struct Tether {
    Vec3 end;
    float radius;
    Index node;  // of the surface, within that radius
  };

  Extraction& extraction_;
  Projector projector_;
  Rails rails_;
  Chords chords_;
  std::vector<Tether> tethers_;
  std::vector<Index> tether_;  // of each vertex, or no_index
};

}  // namespace meshgrain
