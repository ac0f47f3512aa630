#include "extract/disk_clusters.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>
#include <numeric>
#include <span>

#include "extract/entry_jumps.h"
#include "mesh/sort_by_vertex.h"
#include "mesh/vertex_faces.h"
#include "util/collect.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

constexpr std::uint8_t not_zero = 0xff;

/// For each entry of Graph::neighbors between free vertices, the lower one first, the rotation of
/// its jump where that is zero, else `not_zero`.
std::vector<std::uint8_t> zero_jumps(const Graph& graph, const OrientationField& orientation,
                                     const PositionField& position, PositionEnergy energy,
                                     std::span<const std::uint8_t> is_free,
                                     const Context& context) {
  std::vector<std::uint8_t> rotations(graph.neighbors.size(), not_zero);
  for_entry_jumps(
      graph, orientation, position, energy,
      [&](Index i, Index j) { return is_free[i] && is_free[j]; },
      [&](Index entry, const Jump& jump) {
        if (jump.is_zero()) rotations[entry] = static_cast<std::uint8_t>(jump.rotation);
      },
      context);
  return rotations;
}

/// Whether the triangles around a vertex are one closed fan.
bool is_inside(const Mesh& surface, std::span<const Index> around, Index v) {
  // Vertices with more are rare, and may stay alone. As lengths of searches cannot be foretold, it
  // takes less time to look at all of a few places.
  constexpr std::size_t most = 16;
  if (around.size() < 3 || around.size() > most) return false;
  // The edges opposite to the vertex, padded to half of the places or all.
  const std::size_t places = around.size() > most / 2 ? most : most / 2;
  std::array<Index, most> from, to;
  from.fill(no_index);
  for (std::size_t k = 0; k < around.size(); ++k) {
    const auto corners = surface.faces[around[k]];
    const Index a = corners[0], b = corners[1], c = corners[2];
    from[k] = a == v ? b : b == v ? c : a;
    to[k] = a == v ? c : b == v ? a : b;
  }
  // Who comes back to the first edge only after all others has met each of them once.
  std::size_t edge = 0;
  for (std::size_t passed = 1; passed <= around.size(); ++passed) {
    std::size_t next = most;
    for (std::size_t k = places; k-- > 0;) next = from[k] == to[edge] ? k : next;
    if (next == most) return false;
    if (next == 0) return passed == around.size();
    edge = next;
  }
  return false;
}

class DiskSearch {
 public:
  DiskSearch(const Mesh& surface, const Graph& graph, int posy,
             std::span<const std::uint8_t> rotations, std::span<const std::uint8_t> is_free,
             const Context& context)
      : surface_(surface),
        graph_(graph),
        posy_(posy),
        rotations_(rotations),
        is_free_(is_free),
        context_(context),
        parent_(graph.size()),
        rotation_(graph.size(), 0),
        is_bad_(graph.size(), 0) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  DiskClusters run() {
    unite();
    point_at_roots();
    reject_other_jumps();
    reject_other_than_disks();
    std::vector<std::array<Index, 3>> triangles;
    do {
      leave_rejected();
      triangles = between_clusters();
    } while (reject_folds(triangles));
    return {std::move(parent_), std::move(rotation_), std::move(triangles), posy_};
  }

 private:
  /// An edge between free vertices, the lower one first.
  struct Edge {
    Index from, to;
    std::uint8_t rotation;  // of its jump, or not_zero
  };

  int turned(int rotation) const { return rotation < posy_ ? rotation : rotation - posy_; }

  template <typename Body>
  void for_vertices(const Body& body) const {
    for_indices(graph_.size(), body, context_);
  }

  template <typename Body>
  void for_each_edge(Index i, const Body& body) const {
    if (!is_free_[i]) return;
    for (Index e = graph_.offsets[i]; e < graph_.offsets[i + 1]; ++e) {
      const Index j = graph_.neighbors[e];
      if (j > i && is_free_[j]) body(Edge{i, j, rotations_[e]});
    }
  }

  /// The root of i; `rotation_` is from there then.
  Index find(Index i) {
    Index root = i;
    int whole = 0;  // from the root to i
    while (parent_[root] != root) {
      whole = turned(whole + rotation_[root]);
      root = parent_[root];
    }
    for (Index k = i; parent_[k] != root && k != root;) {
      const Index next = parent_[k];
      const int own = rotation_[k];
      parent_[k] = root;
      rotation_[k] = static_cast<std::uint8_t>(whole);
      whole = turned(whole + posy_ - own);
      k = next;
    }
    return root;
  }

  /// First each range of vertices by itself, then what is left between ranges.
  void unite() {
    const auto within_ranges = [&](std::size_t begin, std::size_t end, std::vector<Edge>& left) {
      for (auto i = static_cast<Index>(begin); i < end; ++i) {
        for_each_edge(i, [&](const Edge& edge) {
          if (edge.rotation == not_zero) return;
          if (edge.to < end) {
            unite(edge);
          } else {
            left.push_back(edge);
          }
        });
      }
    };
    for (const Edge& edge : collect<Edge>(graph_.size(), within_ranges, context_)) unite(edge);
  }

  /// The lower one is the root, so that clusters do not depend on the order of the edges.
  void unite(const Edge& edge) {
    if (parent_[edge.from] == parent_[edge.to]) return;
    const Index a = find(edge.from), b = find(edge.to);
    if (a == b) return;
    const int between =
        turned(turned(rotation_[edge.from] + edge.rotation) + posy_ - rotation_[edge.to]);
    if (a < b) {
      parent_[b] = a;
      rotation_[b] = static_cast<std::uint8_t>(between);
    } else {
      parent_[a] = b;
      rotation_[a] = static_cast<std::uint8_t>(turned(posy_ - between));
    }
  }

  /// From here on roots are one step away.
  void point_at_roots() {
    std::vector<Index> roots(graph_.size());
    std::vector<std::uint8_t> rotations(graph_.size());
    for_vertices([&](Index i) {
      int whole = 0;
      Index root = i;
      for (; parent_[root] != root; root = parent_[root]) whole = turned(whole + rotation_[root]);
      roots[i] = root;
      rotations[i] = static_cast<std::uint8_t>(whole);
    });
    parent_.swap(roots);
    rotation_.swap(rotations);
  }

  void reject(Index root) { std::atomic_ref(is_bad_[root]).store(1, std::memory_order_relaxed); }

  /// Clusters with other jumps inside, or around a singularity of the orientation field.
  void reject_other_jumps() {
    for_vertices([&](Index i) {
      for_each_edge(i, [&](const Edge& edge) {
        const Index root = parent_[i];
        if (parent_[edge.to] != root) return;
        const bool fits =
            edge.rotation != not_zero && turned(rotation_[i] + edge.rotation) == rotation_[edge.to];
        if (!fits) reject(root);
      });
    });
  }

  /// A connected part of a surface, and not all of it, is a disk if its Euler number V - E + F
  /// is 1. Each edge between two vertices of a cluster is in two triangles, so that a triangle of
  /// it counts for 1 - 3/2, and one with only one edge of it for -1/2: either lowers the number by
  /// half.
  void reject_other_than_disks() {
    std::vector<int> twice_euler(graph_.size(), 0);
    for_vertices([&](Index i) {
      std::atomic_ref(twice_euler[parent_[i]]).fetch_add(2, std::memory_order_relaxed);
    });
    for_indices(
        surface_.faces.size(),
        [&](Index f) {
          const auto face = surface_.faces[f];
          const Index a = parent_[face[0]], b = parent_[face[1]], c = parent_[face[2]];
          if (a != b && b != c && c != a) return;
          const Index root = b == c ? b : a;
          std::atomic_ref(twice_euler[root]).fetch_sub(1, std::memory_order_relaxed);
        },
        context_);
    for_vertices([&](Index i) {
      if (parent_[i] == i && twice_euler[i] != 2) reject(i);
    });
  }

  /// The vertices of rejected clusters are alone again.
  void leave_rejected() {
    for_vertices([&](Index i) {
      if (!is_bad_[parent_[i]]) return;
      parent_[i] = i;
      rotation_[i] = 0;
    });
    std::ranges::fill(is_bad_, 0);
  }

  std::vector<std::array<Index, 3>> between_clusters() const {
    using Triangle = std::array<Index, 3>;
    const auto look = [&](std::size_t begin, std::size_t end, std::vector<Triangle>& out) {
      for (std::size_t f = begin; f < end; ++f) {
        const auto face = surface_.faces[f];
        const Index a = parent_[face[0]], b = parent_[face[1]], c = parent_[face[2]];
        if (a != b && b != c && c != a) out.push_back({face[0], face[1], face[2]});
      }
    };
    return collect<Triangle>(surface_.faces.size(), look, context_);
  }

  /// Clusters around which the others would not be a simple loop. Returns whether there are any.
  bool reject_folds(const std::vector<std::array<Index, 3>>& triangles) {
    // The triangles' edges by the cluster where they start.
    const auto root_of = [&](std::size_t corner) {
      return parent_[triangles[corner / 3][corner % 3]];
    };
    std::vector<Index> ends(3 * triangles.size());
    const std::vector<Index> offsets = sort_by_vertex(
        ends.size(), graph_.size(), [&](std::size_t corner) { return std::array{root_of(corner)}; },
        [&](std::size_t corner, Index place) {
          ends[place] = root_of(corner % 3 == 2 ? corner - 2 : corner + 1);
        },
        context_);
    std::atomic<bool> any = false;
    const auto reject_cluster = [&](Index root) {
      if (!has_members(root)) return;
      reject(root);
      any = true;
    };
    for_vertices([&](Index i) {
      const std::span<Index> loop{ends.data() + offsets[i], offsets[i + 1] - offsets[i]};
      if (parent_[i] == i && loop.size() < 3) reject_cluster(i);
      std::ranges::sort(loop);
      for (std::size_t k = 1; k < loop.size(); ++k) {
        if (loop[k] != loop[k - 1]) continue;
        reject_cluster(i);
        reject_cluster(loop[k]);
      }
    });
    return any;
  }

  /// Whether a root has others; known as they are its neighbours.
  bool has_members(Index root) const {
    const auto neighbors = graph_.neighbors_of(root);
    return std::ranges::any_of(neighbors, [&](Index j) { return parent_[j] == root; });
  }

  const Mesh& surface_;
  const Graph& graph_;
  int posy_;
  std::span<const std::uint8_t> rotations_, is_free_;
  const Context& context_;
  std::vector<Index> parent_;
  std::vector<std::uint8_t> rotation_;  // of each vertex: from its parent's frame to its own
  std::vector<std::uint8_t> is_bad_;    // of each root
};

/// Roots become the members that are nearest to the lattice point, the lowest of the nearest.
void put_roots_in_the_middle(DiskClusters& disks, const Graph& graph, const PositionField& position,
                             const Context& context) {
  // Of each root, the nearest: the bits of its distance, which are in order like the distances
  // themselves, and its index.
  std::vector<std::uint64_t> middle(graph.size(), std::numeric_limits<std::uint64_t>::max());
  const auto find_nearest = [&](Index i) {
    const float distance = (position.points[i] - graph.positions[i]).squaredNorm();
    const std::uint64_t own = std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32 | i;
    const std::atomic_ref best(middle[disks.root[i]]);
    std::uint64_t least = best.load(std::memory_order_relaxed);
    while (own < least && !best.compare_exchange_weak(least, own, std::memory_order_relaxed)) {
    }
  };
  for_indices(graph.size(), find_nearest, context);
  const std::vector<std::uint8_t> from_old = disks.rotation;
  const auto move_root = [&](Index i) {
    Index& root = disks.root[i];
    const auto to = static_cast<Index>(middle[root]);  // the lower half
    const int turn = from_old[i] + disks.posy - from_old[to];
    disks.rotation[i] = static_cast<std::uint8_t>(turn % disks.posy);
    root = to;
  };
  for_indices(graph.size(), move_root, context);
}

}  // namespace

Jump DiskClusters::between_roots(Index i, Index j, const Jump& jump) const {
  const Jump from_root{rotation[i], {0, 0}}, to_root = reversed({rotation[j], {0, 0}}, posy);
  return composed(composed(from_root, jump, posy), to_root, posy);
}

DiskClusters find_disk_clusters(const Mesh& surface, const Graph& graph,
                                const OrientationField& orientation, const PositionField& position,
                                PositionEnergy energy, std::vector<std::uint8_t> is_free,
                                const Context& context) {
  const VertexFaces around = vertex_faces(surface, context);
  const auto look_around = [&](Index v) {
    is_free[v] = is_free[v] && is_inside(surface, around[v], v);
  };
  for_indices(graph.size(), look_around, context);
  const std::vector<std::uint8_t> rotations =
      zero_jumps(graph, orientation, position, energy, is_free, context);
  DiskClusters disks = DiskSearch(surface, graph, position.posy, rotations, is_free, context).run();
  put_roots_in_the_middle(disks, graph, position, context);
  return disks;
}

}  // namespace meshgrain
