#pragma once

#include <span>
#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Takes the noise out of a surface of triangles and keeps its creases: the normals of the faces
/// are averaged over those neighbours that lie on the same side of every crease (Zheng et al.
/// 2011), as told by the most even patch that is near (Zhang et al. 2015), and vertices move to
/// where the faces have these normals (Sun et al. 2007). Those of the border may stay.
class NormalFilter {
 public:
  enum class Border { stays, moves };

  /// `triangles` must outlive this.
  NormalFilter(Mesh& triangles, Border border, const Context& context);

  static constexpr int rounds = 12;
  /// The rounds until there were so many.
  void run(int end = rounds);

 private:
  struct Facet {
    Vec3 normal, center;
    float area;
  };
  struct Patch {
    Vec3 normal;
    float unevenness;
  };

  void measure_facets();
  void measure_patches();
  void average(float reach, float spread);
  void move_vertices();
  float mean_reach() const;

  /// Faces that share a vertex with face f, itself among them.
  std::span<const Index> around(std::size_t f) const {
    return {neighbors_.data() + starts_[f], starts_[f + 1] - starts_[f]};
  }

  Mesh& mesh_;
  const Context& context_;
  int round_ = 0;
  VertexFaces vertex_faces_;
  std::vector<std::uint8_t> stays_;
  std::vector<std::size_t> starts_;
  std::vector<Index> neighbors_;
  std::vector<Facet> facets_;
  std::vector<Patch> patches_;
  std::vector<Vec3> guides_, normals_;
  std::vector<float> offsets_;  // of the planes with these normals, from zero
};

}  // namespace meshgrain
