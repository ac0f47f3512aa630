#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// The cells of a grid that some boxes touch: tells at once what of a large mesh is near to a few
/// places of it.
class BoxCells {
 public:
  /// Cells are as wide as told, or wider if there would be too many.
  BoxCells(std::span<const Eigen::AlignedBox3f> boxes, float width);

  bool contains(const Vec3& p) const;
  /// Whether a box may meet one of those: it touches such a cell.
  bool touches(const Eigen::AlignedBox3f& box) const;

 private:
  using Cell = Eigen::Array3i;

  Cell cell(const Vec3& p) const { return ((p - low_) / width_).array().floor().cast<int>(); }
  template <typename Body>
  void for_cells(const Eigen::AlignedBox3f& box, const Body& body) const;
  std::size_t place(const Cell& at) const {
    return (static_cast<std::size_t>(at[2]) * static_cast<std::size_t>(counts_[1]) +
            static_cast<std::size_t>(at[1])) *
               static_cast<std::size_t>(counts_[0]) +
           static_cast<std::size_t>(at[0]);
  }

  Eigen::AlignedBox3f all_;
  Vec3 low_ = Vec3::Zero();
  float width_ = 1;
  Cell counts_ = Cell::Zero();
  std::vector<bool> touched_;
};

}  // namespace meshgrain
