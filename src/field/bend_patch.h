#pragma once

#include <array>
#include <optional>
#include <vector>

#include "features/feature_edges.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/curvature.h"
#include "meshgrain/features.h"
#include "meshgrain/hierarchy.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// How a patch of the surface bends: a symmetric matrix of space, integrated over the patch, whose
/// eigenvectors are the axes about which the normal turns, positive where the surface bends away
/// from it. That is the second fundamental form turned by a right angle. In space, forms of
/// different tangent planes can be added, and what bends to and fro adds up to little.
struct BendPatch {
  std::array<float, 6> form{};  // xx, yy, zz, xy, xz, yz
  float area = 0;
  float turn = 0;  ///< As the form, but all bends added up without regard to sign and direction.

  /// Adds a bend about the unit vector u.
  void add(float bend, const Vec3& u);
  void add(const BendPatch& other);
  float product(const Vec3& u, const Vec3& v) const;  ///< uᵀ form v
  float norm() const;  ///< sqrt(kmin² + kmax²) of the mean form, 0 without area.
};

/// The patches that the nodes of a hierarchy stand for.
///
/// On a mesh whose vertices are the nodes, a patch's form is the sum over its edges of the angle
/// between the faces, times the length (Cohen-Steiner and Morvan 2003): right for fine and coarse
/// triangles alike. Edges on the lines of `creases` are left out. Other graphs take the form of
/// estimate_curvature(), turned by a right angle.
///
/// The arguments must outlive it.
class BendPatches {
 public:
  /// `around`: the faces around the vertices of `surface`, where these are the nodes.
  BendPatches(const Hierarchy& hierarchy, const Mesh& surface, const VertexFaces& around,
              const FeatureLines& creases, const Context& context);

  /// That of a node of any level. Takes time in proportion to the vertices that it stands for.
  BendPatch of(std::size_t level, Index node) const;

 private:
  BendPatch of_vertex(Index vertex) const;

  const Hierarchy& hierarchy_;
  const Mesh& surface_;
  const VertexFaces& around_;
  FeatureEdges creases_;
  std::optional<Curvature> curvature_;  // of the nodes, where these are not vertices
};

/// That of a node together with those of its neighbours.
BendPatch with_neighbors(const Graph& graph, const std::vector<BendPatch>& patches, Index node);

/// Whether the nodes of a hierarchy are the vertices of this mesh.
bool are_vertices(const Hierarchy& hierarchy, const Mesh& surface);

/// The first level whose nodes are this large in the mean, or the last.
std::size_t level_of_area(const Hierarchy& hierarchy, double area);

}  // namespace meshgrain
