#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain::shapes {

/// Adds the quad as two triangles that share its shorter diagonal.
void add_quad(Mesh& mesh, Index a, Index b, Index c, Index d);

/// Joins structured patches into one mesh: border vertices of patches that coincide become one, so
/// that patches need no knowledge of each other beyond sampling a common border alike.
class PatchBuilder {
 public:
  /// A grid of `columns` x `rows` cells with its vertices at `point(u, v)`, u and v in [0, 1]. The
  /// patch faces the side from which the turn from u to v is anticlockwise.
  template <class Point>
  void grid(int columns, int rows, Point&& point) {
    std::vector<Index> below, row(columns + 1);
    for (int j = 0; j <= rows; ++j) {
      for (int i = 0; i <= columns; ++i) {
        const Vec3 p = point(double(i) / columns, double(j) / rows);
        const bool border = i == 0 || i == columns || j == 0 || j == rows;
        row[i] = border ? shared_vertex(p) : new_vertex(p);
      }
      for (int i = 0; i < columns && j > 0; ++i)
        add_quad(mesh_, below[i], below[i + 1], row[i + 1], row[i]);
      below = row;
    }
  }

  /// A triangle with `cells` cells along each side, its vertices at `point(a, b, c)` of barycentric
  /// coordinates. It faces the side from which the three corners turn anticlockwise.
  template <class Point>
  void triangle(int cells, Point&& point) {
    std::vector<Index> below, row;
    for (int j = 0; j <= cells; ++j) {
      row.clear();
      for (int i = 0; i <= cells - j; ++i) {
        const double b = double(i) / cells, c = double(j) / cells;
        const Vec3 p = point(double(cells - i - j) / cells, b, c);
        const bool border = i == 0 || j == 0 || i + j == cells;
        row.push_back(border ? shared_vertex(p) : new_vertex(p));
      }
      for (int i = 0; i <= cells - j && j > 0; ++i) {
        mesh_.faces.push_back({below[i], below[i + 1], row[i]});
        if (i < cells - j) mesh_.faces.push_back({below[i + 1], row[i + 1], row[i]});
      }
      below = row;
    }
  }

  Mesh take() { return std::move(mesh_); }

 private:
  using Cell = std::array<std::int32_t, 3>;
  struct CellHash {
    std::size_t operator()(const Cell& cell) const;
  };

  Index new_vertex(const Vec3& p);
  Index shared_vertex(const Vec3& p);

  Mesh mesh_;
  std::unordered_map<Cell, Index, CellHash> border_;
};

}  // namespace meshgrain::shapes
