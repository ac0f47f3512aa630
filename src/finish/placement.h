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
  /// Whether it may go anywhere on the surface.
  bool is_free(std::size_t v) const { return !is_fixed(v) && rails_.seed[v] == no_index; }

  /// Holds v at a point of the surface, near a node of it.
  void pin(std::size_t v, const Vec3& p, Index node);

  /// Lets v leave the line that holds it. Returns whether there was one.
  bool release(std::size_t v);

  /// The normal of the surface where vertex v is.
  Vec3 normal(std::size_t v) const { return projector_.normal(extraction_.nodes[v]); }

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
  Extraction& extraction_;
  const Mesh& surface_;
  Projector projector_;
  FeatureLines lines_;
  Rails rails_;
};

}  // namespace meshgrain
