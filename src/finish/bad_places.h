#pragma once

#include <cstddef>
#include <vector>

#include "finish/local_search.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// One or two bad faces with some rings of others, how they are, and what may stay bad among them.
struct BadPlace {
  std::vector<Index> faces;
  std::vector<Index> vertices;  // those with all of their faces in it
  std::vector<LocalSearch::Place> before;
  std::vector<Index> at_bad;  // those of them that belong to bad faces
  std::size_t crossings = 0;  // pairs of faces that pass through each other
  std::size_t bad = 0;        // faces
  std::size_t poor = 0;       // faces: what is mended must not become so elsewhere
  bool may_cross = false;     // as the surface itself does
};

/// Says which faces are bad, and what is wrong at a place. All that it is given must outlive it.
class BadPlaces {
 public:
  /// What makes a face acceptable.
  struct Demands {
    bool along_surface;  // it looks where the surface does; else only where its neighbours do
    float quality;       // as of LocalSearch
  };

  BadPlaces(const Mesh& mesh, const VertexFaces& around, const LocalSearch& search,
            const Context& context)
      : mesh_(mesh), around_(around), search_(search), context_(context) {}

  void demand(const Demands& demands) { demands_ = demands; }
  const Demands& demands() const { return demands_; }

  bool is_bad(Index f) const { return falls_short(f, demands_); }

  /// `rings` of faces around f and g, as it is now.
  BadPlace around(Index f, Index g, int rings) const;

  /// Whether so much passes through itself that nothing can be done about it.
  static bool is_hopeless(const BadPlace& place) {
    return place.crossings >= most_crossings(place);
  }

  /// Faces and pairs of faces that are wrong now and may not be; no more are counted than `limit`.
  std::size_t wrong(const BadPlace& place, std::size_t limit) const;
  bool is_mended(const BadPlace& place) const { return wrong(place, 1) == 0; }

 private:
  static std::size_t most_crossings(const BadPlace& place);
  bool falls_short(Index f, const Demands& demands) const;
  std::size_t count_short(const BadPlace& place, const Demands& demands, std::size_t limit) const;
  std::size_t count_crossings(const BadPlace& place, std::size_t limit) const;

  const Mesh& mesh_;
  const VertexFaces& around_;
  const LocalSearch& search_;
  const Context& context_;
  Demands demands_{};
};

}  // namespace meshgrain
