#pragma once

#include "finish/feature_lines.h"
#include "finish/projector.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Where the vertices of a mesh over a surface may go: inner ones anywhere on it, those on the
/// border and on creases along these, corners nowhere.
class Placement {
 public:
  /// `crease_degrees` is that of SmoothOptions. All three must outlive this.
  Placement(Extraction& extraction, const Mesh& surface, const Graph& graph, double crease_degrees,
            const Context& context);

  /// The place nearest to `p` that vertex v may have. Remembers in Extraction::nodes where that is,
  /// so that calls for the same vertex must not run at once.
  Vec3 place(const Vec3& p, std::size_t v);

  bool is_fixed(std::size_t v) const { return rails_.fixed[v]; }
  bool is_tethered(std::size_t v) const { return tether_[v] != no_index; }
  /// Whether it may go anywhere on the surface.
  bool is_free(std::size_t v) const {
    return !is_fixed(v) && rails_.seed[v] == no_index && !is_tethered(v);
  }

  /// Moves v to a point of the surface, near a node of it; from then on it stays within `radius` of
  /// `end`, or as near as it then is.
  void tether(std::size_t v, const Vec3& p, Index node, const Vec3& end, float radius);

  /// Lets v leave the line that holds it. Returns whether there was one.
  bool release(std::size_t v);

  /// The normal of the surface where vertex v is.
  Vec3 normal(std::size_t v) const { return projector_.normal(extraction_.nodes[v]); }

  const Projector& projector() const { return projector_; }

  /// What place() remembers of a vertex, to go back to.
  struct Seed {
    Index node, on_line;
  };
  Seed seed(std::size_t v) const { return {extraction_.nodes[v], rails_.seed[v]}; }
  void set_seed(std::size_t v, const Seed& seed) {
    extraction_.nodes[v] = seed.node;
    rails_.seed[v] = seed.on_line;
  }

 private:
  struct Tether {
    Vec3 end;
    float radius;
  };

  Extraction& extraction_;
  const Mesh& surface_;
  Projector projector_;
  FeatureLines lines_;
  Rails rails_;
  std::vector<Tether> tethers_;
  std::vector<Index> tether_;  // of each vertex, or no_index
};

}  // namespace meshgrain
