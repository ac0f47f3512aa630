#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <vector>

#include "extract/clusters.h"
#include "extract/link_condition.h"
#include "extract/polygon_map.h"
#include "field/jumps.h"
#include "meshgrain/context.h"

namespace meshgrain {

/// Turns the orbits of a map into the faces that a position field of symmetry `posy` asks for:
/// triangles for 6, mostly quads for 4.
class FaceRepair {
 public:
  /// `holes`: a flag for each halfedge, whether its orbit is open. `lines`: the feature line of
  /// each edge, or no_index; these edges stay.
  FaceRepair(PolygonMap& map, Clusters& clusters, int posy, std::vector<std::uint8_t> holes,
             std::vector<Index> lines);

  // For faces that were found by walking around a graph (face_repair.cpp).

  /// Removes edges that have the same orbit on both sides: dangling ones and bridges.
  void remove_dangling();

  /// Cuts vertices at which an orbit touches itself, and closes the orbits of two edges that this
  /// can leave: every orbit is then a simple polygon.
  void cut_pinches();

  /// Marks orbits as open: those that run along the border of the surface (`border_edges`: one flag
  /// an edge; `border_vertices`), and what is longer than `largest_gap`.
  void find_holes(std::span<const std::uint8_t> border_edges,
                  std::span<const std::uint8_t> border_vertices, std::size_t largest_gap);

  /// Where a line runs straight along two edges of one face, gives that face another edge there:
  /// to another corner, or to a new vertex in its middle.
  void part_straight_angles();

  // Quads (quad_repair.cpp).

  struct EdgeChange {
    int gain = 0;            // by how much the number of irregular faces and vertices falls
    double cost = 0;         // how irregular the new faces are
    Index h = no_index;      // of the edge to take away
    int from = -1, to = -1;  // corners of the union, for an edge in its place; -1: none
  };
  void apply(const EdgeChange& change);
  /// Removes interior vertices with two edges, which no regular mesh has.
  void remove_doublets();

  /// Removes the edges between triangles that the lattice has as a square's diagonal (`jumps`: one
  /// an edge). A triangle around a singularity may have two of them, and become a pentagon.
  void remove_diagonals(std::span<const Jump> jumps, const Context& context);

  /// Quads: takes edges away, or turns them within the two faces beside them, as long as that
  /// leaves fewer irregular faces and vertices, the greatest gain first. So pairs of triangles
  /// become quads, and the long side of a flat triangle makes way for a T-junction.
  void improve_edges(const Context& context);

  /// Closes quads by merging two opposite corners, as long as that leaves fewer irregular vertices.
  void close_quads(const Context& context);
  /// Closes `count` of them, wherever it leaves the fewest. Returns how many it could.
  std::size_t close_quads(std::size_t count, const Context& context);
  /// Merges the corner opposite to the origin of h into that, which stays where it is if anything
  /// holds it.
  void close_quad(Index h);
  /// Whether that can be done without a change of the topology, the borders or the lines.
  bool may_close(Index h) const;
  /// For what halfedges that can be done to a face or to those beside it, without a change of the
  /// topology, the borders or the lines: where the two are nearest to each other first. Vertices
  /// with two edges may be left, see remove_doublets().
  std::vector<Index> ways_to_close(Index face) const;

  /// Whether an edge between two quads can be turned within them: taken away, and put between two
  /// other corners, `from` and `from` + 3 of union_halfedges().
  bool may_turn(Index h, int from) const;
  /// How edges of a quad can be turned within it and the quad beyond.
  std::vector<EdgeChange> ways_to_turn(Index face) const;
  /// The corners of the two quads that this leaves.
  std::array<std::array<Index, 4>, 2> turned(const EdgeChange& way) const;

  /// The opposite: cuts vertices with far too many edges in two, with a quad in between, as long as
  /// that leaves fewer irregular vertices.
  void open_vertices();
  /// Cuts `count` of them, however many edges they have, wherever it leaves the fewest. Returns how
  /// many it could.
  std::size_t open_vertices(std::size_t count, const Context& context);

  // Quads alone (even_faces.cpp): what pair_odd_faces() does to the faces on its ways.

  /// Whether the faces beside an edge may become one.
  bool may_remove(Index h) const;
  /// Whether the origin of h would be left with a face that has a straight angle there, between two
  /// edges of feature lines, if the edge of h went.
  bool is_last_rung(Index h) const;

  /// Whether two triangles may become a quad: at a vertex of a line, even with no other edge
  /// between them if the line bends enough for a corner.
  bool may_join_triangles(Index h) const;

  /// Puts a vertex in the middle of an edge: h then ends there.
  void split_edge(Index h);

  /// Whether an edge of a line may vanish together with the triangle on the left of h.
  bool may_contract_line(Index h) const;
  void contract_line(Index h);

  /// Cuts a face with an even number of corners into quads.
  void cut_into_quads(Index h);

  // Triangles (triangle_repair.cpp).

  /// Turns the edge between two triangles as long as that leaves fewer irregular vertices.
  void flip_edges(const Context& context);
  /// Contracts `count` edges, each where that leaves the fewest irregular vertices. Returns how
  /// many it could.
  std::size_t contract_edges(std::size_t count, const Context& context);

  /// Splits faces with more corners than the symmetry allows along their best chords. A face of a
  /// 6-PoSy that no chord can split, as its corners are joined outside of it already, gets a vertex
  /// in its middle.
  void split_large();

  bool is_hole(Index h) const { return hole_[h]; }
  /// Whether a vertex may go anywhere.
  bool is_loose(Index vertex) const {
    return !clusters_.on_border[vertex] && clusters_.hold[vertex] == free_vertex;
  }
  /// The feature line that the edge of h is part of, or no_index.
  Index line(Index h) const { return lines_[h / 2]; }

 private:
  double corner_angle(Index h) const;
  double angle(Index v, Index from, Index to) const;
  double polygon_cost(std::span<const Index> corners) const;
  bool same_orbit(Index a, Index b) const;
  EdgeChange best_change(Index h) const;
  /// An inner vertex of a quad mesh is regular with four edges, one of the border with three.
  static int regular_valence(bool on_border) { return on_border ? 3 : 4; }
  /// Whether a vertex is irregular for quads once it has `change` more edges.
  bool is_irregular(Index vertex, int change) const;
  /// The halfedges around the two faces of an edge, without it.
  std::vector<Index> union_halfedges(Index h) const;
  /// Whether an edge between two of those would be held, and leave a straight angle beside it.
  bool leaves_straight_angle(const std::vector<Index>& around, int from, int to) const;
  /// Whether what the two become without the edge would have a corner twice.
  bool touches_itself(Index h) const;
  /// Whether a vertex is at a corner of creases: those of the border may be let go.
  bool stays(Index v) const { return clusters_.hold[v] == at_corner && !clusters_.on_border[v]; }
  /// Whether an edge stays where it is: on a line, or from one corner of creases to another.
  bool is_held(Index h) const {
    return line(h) != no_index || (stays(map_.origin(h)) && stays(map_.target(h)));
  }
  bool is_between_lines(Index to, Index from) const { return is_held(to) && is_held(from); }
  /// Whether a face between two edges of feature lines, that leave the origin of `to` and come from
  /// `from`, has a straight angle there. `normal` is that of the face.
  bool is_straight(Index to, Index from, const Vec3& normal) const;
  /// The same at a vertex between two others of a face.
  bool is_straight(Index v, Index ahead, Index back, const Vec3& normal) const;
  Vec3 face_normal(Index h) const;
  /// Whether a face of that normal looks away from the surface at one of its vertices.
  bool is_turned_over(Index vertex, const Vec3& normal) const;
  bool is_alone(Index h) const;
  bool make_room(Index h);
  bool join_across_hole(Index h);
  bool join_beyond(Index h);
  bool part_face(Index h);
  /// By how much the number of irregular vertices falls if the origin of h and the corner opposite
  /// to it in their quad become one; nothing if they must not, or it is less than `least`.
  std::optional<int> closing_gain(Index h, int least) const;
  /// A way to cut a vertex in two: its edges from `first` clockwise up to `last` go to a new
  /// vertex, and the other ends of these two get an edge to both.
  struct Opening {
    int gain = 0;     // by how much the number of irregular vertices falls
    int squares = 0;  // of what the vertices then have too many edges or too few: how many more
    Index first = no_index, last = no_index;
    /// What is larger for a better one.
    constexpr auto worth() const { return std::tuple(gain, -squares); }
  };
  bool may_open(Index vertex) const;
  /// The best one that starts at `first`, if any gains `least` or more.
  std::optional<Opening> opening_from(Index first, int least) const;
  std::optional<Opening> best_opening(Index vertex) const;
  void open(const Opening& opening);
  /// The same for contracting h between triangles.
  std::optional<int> contraction_gain(Index h);
  /// Whether the origin of h and the corner opposite to it in their quad have nothing in common but
  /// that; else other faces would come to touch themselves if the two became one.
  bool are_apart(Index h) const;
  float distance(Index a, Index b) const {
    return (clusters_.positions[a] - clusters_.positions[b]).norm();
  }
  /// Applies the change with the greatest gain `count` times, of several the one of the least cost.
  /// `gain` may say nothing where it is less than `least`, which at first is less than any.
  template <typename Worth, typename Gain, typename Cost, typename Apply>
  std::size_t change_best(std::size_t count, const Worth& least, const Gain& gain, const Cost& cost,
                          const Apply& apply, const Context& context);
  int flip_gain(Index h) const;
  double chord_cost(std::span<const Index> orbit, std::size_t from) const;
  Vec3 along(Index h) const;
  bool is_bent(Index h) const;
  bool is_corner_without(Index h) const;
  bool split_once(Index h);
  void contract(Index h);
  Index add_edge(Index a, Index b);
  void add_hub(Index h);
  void cut(Index a, Index b);

  PolygonMap& map_;
  Clusters& clusters_;
  int posy_;
  std::vector<std::uint8_t> hole_;  // one flag a halfedge
  std::vector<Index> lines_;        // one an edge
  LinkCondition link_;
};

template <typename Worth, typename Gain, typename Cost, typename Apply>
std::size_t FaceRepair::change_best(std::size_t count, const Worth& least, const Gain& gain,
                                    const Cost& cost, const Apply& apply, const Context& context) {
  // Beside what a change for the worse left, the next one may cost less: then the others wait, but
  // not so many that there would be a pass over everything for each of thousands.
  constexpr std::size_t passes = 64;
  struct Candidate {
    float cost;
    Index h;
  };
  std::size_t done = 0;
  while (done < count) {
    context.check();
    Worth best = least;
    std::vector<Candidate> candidates;  // with that gain
    for (Index h = 0; h < map_.halfedges(); ++h) {
      const std::optional<Worth> found = gain(h, best);
      if (!found || *found < best) continue;
      if (best < *found) candidates.clear();
      best = *found;
      candidates.push_back({cost(h), h});
    }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      return std::tie(a.cost, a.h) < std::tie(b.cost, b.h);
    });
    const std::size_t before = done;
    const std::size_t most = best < Worth{} ? (count - done + passes - 1) / passes : count - done;
    for (const Candidate& c : candidates) {
      if (done == before + most) break;
      if (gain(c.h, best) != best) continue;  // what lies beside it has changed
      apply(c.h);
      ++done;
    }
    if (done == before) break;
  }
  return done;
}

}  // namespace meshgrain
