#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "finish/placement.h"
#include "finish/vertex_batches.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Moves single vertices over the surface to where the faces around them are best, by trying places
/// (Hooke and Jeeves 1961): for the few faces that a smooth optimisation leaves bad.
class LocalSearch {
 public:
  /// All must outlive this.
  LocalSearch(Extraction& extraction, const VertexFaces& around, Placement& placement,
              const Context& context);

  /// What a face is worth: the least sine of its corners (a quad's scaled Jacobian), seen along the
  /// normal of the face; negative where a corner is turned in, and below -1 if the whole face looks
  /// away from the surface.
  float quality(Index f) const { return quality_[f]; }

  /// The same with the normals of the faces around its corners in place of the surface's.
  float quality_among_neighbors(Index f) const;

  /// Tries each of the vertices (none of them twice), and again while any of them moves. Returns
  /// whether one did.
  bool improve(std::span<const Index> vertices, int sweeps, const Context& context);

  /// Faces that, from now on, are also bad where they pass through each other.
  void keep_apart(std::vector<Index> faces);

  /// The mean of the other corners of the faces around a vertex.
  Vec3 mean_neighbor(Index v) const;

  /// Where a vertex is.
  struct Place {
    Vec3 position;
    Placement::Seed seed;
  };
  Place place(Index v) const { return {mesh_.positions[v], placement_.seed(v)}; }
  /// Puts vertices at places, one for each.
  void put(std::span<const Index> vertices, std::span<const Place> places);

  /// To be called when a vertex, or what is asked of it, has changed: it is then tried again.
  void touch(Index v) { moved_[v] = ++now_; }

 private:
  struct Rival {
    Index face;
    std::optional<Eigen::AlignedBox3f> box;  // none if it moves with the vertex being tried
  };

  /// Where the surface looks under a face.
  struct Upward {
    Vec3 of_all, of_free;  // of_free: zero if it is no different
  };

  /// What stays the same around a vertex while it is tried at several places.
  struct Star {
    std::vector<Upward> upward;  // of its faces
    std::vector<Rival> near;
  };

  bool has_news(Index v) const;
  bool improve(Index v);
  float first_step(Index v) const;
  Upward upward(Index f) const;
  float quality_here(Index f, const Vec3& area, const Upward& upward) const;
  float quality_here(Index f) const;
  /// What the shapes of the faces around a vertex lack, the worst counting most, and how uneven
  /// they are; from `limit` on it need not be exact. `upward`: of those faces.
  float shape_lack(Index v, std::span<const Upward> upward, float limit) const;
  /// With how they pass through others.
  float lack(Index v, const Star& star, float limit) const;
  /// The rivals that the faces around v may meet when it moves by up to a distance.
  std::vector<Rival> rivals_near(Index v, float distance) const;
  float crossing(Index f, std::span<const Rival> near, float limit) const;

  Mesh& mesh_;
  const VertexFaces& around_;
  Placement& placement_;
  std::vector<float> quality_;  // of each face
  std::vector<Vec3> normals_;   // of the surface, where each vertex is
  float mean_area_ = 0;
  std::vector<Index> rivals_;           // see keep_apart()
  std::vector<std::uint8_t> is_rival_;  // of each face
  VertexBatches batches_;
  std::uint32_t now_ = 0;                     // counts batches and moves
  std::vector<std::uint32_t> tried_, moved_;  // when each vertex last was
};

}  // namespace meshgrain
