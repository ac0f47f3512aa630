#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"
#include "sharpen/chamfers.h"

namespace meshgrain {

/// Of a surface whose creases have become chamfers, with them sharp again. It changes the mesh,
/// which must outlive it.
class ChamferSharpening {
 public:
  using Point = Eigen::Vector3d;
  using Edge = std::array<Index, 2>;

  ChamferSharpening(Mesh& mesh, const Context& context);

  /// The edges between parts that meet in one.
  std::vector<Edge> creases() const;

  /// How many vertices inside have only one of the edges.
  std::size_t loose_ends(std::span<const Edge> creases) const;

  /// Puts short creases with such an end back to where they were, as far as they have no branches.
  void give_up_loose();

  /// Which share of the vertices on creases had to go back to where they were.
  double share_put_back() const {
    const auto on = static_cast<double>(std::ranges::count(is_on_, 1));
    return on > 0 ? static_cast<double>(put_back_) / on : 0;
  }

 private:
  using Corners = std::array<Index, 3>;
  /// An edge between two triangles that became the other diagonal.
  struct Turn {
    Edge from, to;
    std::array<Index, 2> faces;
    std::array<Corners, 2> before;
  };
  static constexpr int edges = 4;          // corners are wider than chamfers
  static constexpr double near = 0.25;     // edges; vertices so near to a crease move onto it
  static constexpr double far = 1.5;       // edges; creases are no farther off a chamfer, and
  static constexpr double far_corner = 3;  // corners off where their creases were found to meet

  void move_vertices();
  void end_at_rim();
  void split();
  void find_parts_of_faces();
  void place_corners();
  void space_out();
  void find_neighbours_on_crease();
  bool may_slide(Index v) const;
  void slide(std::span<const Index> moving);
  std::vector<Index> near_folds() const;
  void grow(std::vector<Index>& vertices, int reach) const;
  void turn_edges();
  bool turn_edges_apart();
  bool turn(Index f, std::size_t k, std::vector<std::uint8_t>& is_taken);
  bool turn_back(Index face);
  void keep_apart();

  bool is_crossed(Index a, Index b) const {
    return !is_on_[a] && !is_on_[b] && chamfers_.meet_in_crease(a, b);
  }
  Point place(Index v) const { return mesh_.positions[v].cast<double>(); }
  Corners corners_of(Index f) const {
    const auto c = std::as_const(mesh_.faces)[f];
    return {c[0], c[1], c[2]};
  }
  /// Of a triangle as seen from a side: its area, to the square of its longest edge.
  double roundness(const Corners& t, const Point& up) const {
    const Point a = place(t[0]), b = place(t[1]), c = place(t[2]);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    return longest > 0 ? (b - a).cross(c - a).dot(up) / (longest * longest) : 0;
  }
  /// Whether it looks away from its part.
  bool is_folded(Index f) const {
    return part_of_[f] != no_index &&
           roundness(corners_of(f), chamfers_.plane(part_of_[f]).normal) <= 0;
  }
  Index part_beside(Index f) const;
  std::vector<Plane> parts_around(Index v) const;

  Mesh& mesh_;
  const Mesh before_;
  const Context& context_;
  const Chamfers chamfers_;
  const std::vector<Edge> rim_;
  std::vector<std::uint8_t> stays_;                   // of each vertex: those of the rim do
  std::vector<std::uint8_t> is_on_;                   // a crease, of each vertex
  VertexFaces around_;                                // once all are split
  std::vector<Vec3> origins_;                         // of each vertex, on the surface as it was
  std::vector<Index> part_of_;                        // of each face a vertex of its part
  std::vector<std::vector<Index>> on_crease_beside_;  // of each vertex, along its creases
  std::vector<Turn> turns_;
  std::size_t put_back_ = 0;
};

}  // namespace meshgrain
