#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <span>
#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

struct Plane {
  Eigen::Vector3d normal, point;

  double height(const Eigen::Vector3d& p) const { return normal.dot(p - point); }
};

/// Whether surfaces that touch these planes would meet in a crease.
bool meet_in_crease(const Plane& a, const Plane& b);

/// Where a surface is smooth, and of which smooth part each vertex in between is: of chamfers that
/// are about as narrow as the triangles the vertices of one side are of one part, and those of the
/// other side of another.
class Chamfers {
 public:
  /// Tells of vertices up to so many edges from what is smooth, of which part they are. The mesh
  /// must outlive this, and stay as it is.
  Chamfers(const Mesh& triangles, int edges, const Context& context);

  bool is_smooth(Index v) const { return part_of_[v] == v; }
  bool has_part(Index v) const { return part_of_[v] != no_index; }

  /// That touches the part of a vertex near there.
  Plane plane(Index v) const {
    const Index w = part_of_[v];
    return {normals_[w].cast<double>(), position(w)};
  }
  Eigen::Vector3d position(Index v) const { return mesh_.positions[v].cast<double>(); }

  /// Whether two vertices are of parts that would meet in a crease.
  bool meet_in_crease(Index a, Index b) const {
    return has_part(a) && has_part(b) && meshgrain::meet_in_crease(plane(a), plane(b));
  }

  /// Of each vertex beside v; of most twice, as they are in two faces.
  template <typename Body>
  void each_beside(Index v, const Body& body) const {
    for (const Index f : around_[v]) {
      for (const Index w : mesh_.faces[f]) {
        if (w != v) body(w);
      }
    }
  }

  /// Whether it holds of any vertex beside v.
  template <typename Test>
  bool any_beside(Index v, const Test& test) const {
    return std::ranges::any_of(around_[v], [&](Index f) {
      return std::ranges::any_of(mesh_.faces[f], [&](Index w) { return w != v && test(w); });
    });
  }

  /// The mean length of an edge.
  double edge() const { return edge_; }

 private:
  void find_smooth();
  void leave_out_small();
  void straighten_normals();
  void spread();
  double depth_behind(std::span<const Index> parts, const Plane& own,
                      const Eigen::Vector3d& point) const;
  /// As long as twice the area of the face.
  Eigen::Vector3d normal_and_area(Index f) const {
    const auto c = mesh_.faces[f];
    return (position(c[1]) - position(c[0])).cross(position(c[2]) - position(c[0]));
  }
  template <typename Change>
  void change_parts(const Change& change);

  const Mesh& mesh_;
  const Context& context_;
  VertexFaces around_;
  double edge_;
  std::vector<Vec3> normals_;
  std::vector<Index> part_of_;  // a smooth vertex of the part; itself if it is one
};

}  // namespace meshgrain
