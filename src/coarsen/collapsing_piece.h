#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "meshgrain/surface.h"

namespace meshgrain {

/// Some triangles of a mesh whose edges are collapsed.
class CollapsingPiece {
 public:
  using Triangle = std::array<Index, 3>;

  /// Corners are places in `positions`. Vertices that other pieces have, too, must not be free.
  CollapsingPiece(std::vector<Vec3> positions, std::vector<std::uint8_t> is_free,
                  std::span<const Triangle> triangles);

  void collapse_short_edges(const CoarseEdges& edges);

  const std::vector<Vec3>& positions() const { return positions_; }
  bool is_gone(Index v) const { return is_free_[v] && rings_[v].size == 0; }
  std::vector<Triangle> triangles() const;

 private:
  static constexpr std::size_t most_neighbors = 11;

  /// The neighbours of a free vertex in order around it.
  struct Ring {
    std::array<Index, most_neighbors> around;
    Index size = 0;

    std::size_t after(std::size_t k) const { return k + 1 < size ? k + 1 : 0; }
    std::size_t find(Index v) const {
      std::size_t k = 0;
      while (k < size && around[k] != v) ++k;
      return k;
    }
    void remove(Index v);
  };

  /// The triangles beside an edge that are left when it goes: their corners, `center` being the end
  /// of the edge, and their normals, twice as long as their areas. All are looked at side by side,
  /// so that the compiler can use SIMD, in whole rows of lanes: the last triangle comes again to
  /// fill the last.
  struct Star {
    static constexpr std::size_t lanes = 8, most = 3 * lanes;
    static_assert(most >= 2 * most_neighbors);
    struct Vectors {
      alignas(4 * lanes) std::array<float, most> x, y, z;
      void set(std::size_t k, const Vec3& p) { x[k] = p.x(), y[k] = p.y(), z[k] = p.z(); }
    };
    Vectors center, from, to, normals;
    std::size_t size = 0;

    void add(const Vec3& at, const Vec3& p, const Vec3& q);
    void fill_row();
    void find_normals();

    /// Calls `body(k)` for each triangle and what fills the last row.
    template <typename Body>
    void for_each(const Body& body) const {
      for (std::size_t row = 0; row < size; row += lanes) {
        for (std::size_t lane = 0; lane < lanes; ++lane) body(row + lane);
      }
    }
  };

  void find_rings(std::span<const Triangle> triangles);
  /// The ring of a vertex from the edges opposite to it. False if these are not one closed fan.
  static bool follow(std::span<const std::array<Index, 2>> edges, Ring& ring);
  double mean_edge() const;
  /// Returns how many vertices went.
  std::size_t sweep(float shortest);
  bool collapse(Index a, Index b);
  bool keeps_topology(Index a, Index b) const;
  Star star(Index a, Index b) const;
  Vec3 best_place(Index a, Index b, const Star& star) const;
  bool keeps_shape(const Star& star, const Vec3& place) const;

  std::vector<Vec3> positions_;
  std::vector<std::uint8_t> is_free_;
  std::vector<std::uint8_t> is_new_;  // what is near has changed since it was looked at
  std::vector<std::uint16_t> faces_;  // around each vertex in this piece
  std::vector<Ring> rings_;
  std::vector<Triangle> fixed_;  // triangles that have no free vertex
  float longest_ = 0;
};

}  // namespace meshgrain
