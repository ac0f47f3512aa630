#pragma once

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "measure/bvh.h"
#include "mesh/box_cells.h"
#include "mesh/cut_apart.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Where faces pass through each other because of what the surface is: it passes through itself no
/// farther than a face away, or they cover two pieces of it that touch, such as parts of a machine
/// that were put together.
class InherentCrossings {
 public:
  /// `side`: of a face. The surface and its cuts must outlive this, and stay as they are.
  InherentCrossings(const Mesh& surface, const Cuts& cuts, double side, const Context& context);

  /// Whether the surface passes through itself near to where two faces of a mesh do.
  bool are_near(const Mesh& mesh, const std::array<Index, 2>& faces) const;

  /// Whether two vertices of the surface are of different pieces that touch.
  bool do_touch(Index v, Index w);

 private:
  struct Piece {
    std::vector<Index> vertices;
    std::vector<Triangle> triangles;
    Eigen::AlignedBox3f box;
    std::unique_ptr<Bvh> tree;  // once it is asked for
  };

  void find_pieces();
  bool come_near(const Piece& piece, Piece& other) const;

  const Mesh& surface_;
  const Cuts& cuts_;
  const float near_;  // pieces that are nearer than this touch
  BoxCells crossings_;
  // Once they are asked for.
  std::vector<Index> piece_of_;  // each vertex
  std::vector<Piece> pieces_;
  std::map<std::pair<Index, Index>, bool> touching_;
};

}  // namespace meshgrain
