#include "extract/disk_clusters.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "mesh/vertex_faces.h"

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
  context.for_ranges(graph.size(), 2048, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      if (!is_free[i]) continue;
      for (Index e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
        const Index j = graph.neighbors[e];
        if (j < i || !is_free[j]) continue;
        const Jump jump = edge_jump(graph, orientation, position, energy, i, j);
        if (jump.is_zero()) rotations[e] = static_cast<std::uint8_t>(jump.rotation);
      }
    }
  });
  return rotations;
}

/// Whether the triangles around a vertex are one closed fan. `rim` gets their edges opposite to it.
bool is_inside(const Mesh& surface, std::span<const Index> around, Index v,
               std::vector<std::array<Index, 2>>& rim) {
  if (around.size() < 3) return false;
  rim.clear();
  for (const Index f : around) {
    const auto corners = surface.faces[f];
    const std::size_t k = corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
    rim.push_back({corners[(k + 1) % 3], corners[(k + 2) % 3]});
  }
  std::size_t edge = 0;
  for (std::size_t passed = 1; passed <= rim.size(); ++passed) {
    std::size_t next = rim.size();
    for (std::size_t k = 0; k < rim.size(); ++k) {
      if (rim[k][0] != rim[edge][1]) continue;
      if (next != rim.size()) return false;
      next = k;
    }
    if (next == rim.size()) return false;
    if (next == 0) return passed == rim.size();
    edge = next;
  }
  return false;
}

class DiskSearch {
 public:
  DiskSearch(const Mesh& surface, const Graph& graph, int posy,
             std::span<const std::uint8_t> rotations, std::span<const std::uint8_t> is_free)
      : surface_(surface),
        graph_(graph),
        posy_(posy),
        rotations_(rotations),
        is_free_(is_free),
        parent_(graph.size()),
        rotation_(graph.size(), 0),
        is_bad_(graph.size(), 0) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  DiskClusters run() {
    unite();
    reject_contradictions();
    reject_other_than_disks();
    std::vector<std::array<Index, 3>> triangles;
    do {
      leave_rejected();
      triangles = between_clusters();
    } while (reject_folds(triangles));
    return {std::move(parent_), std::move(rotation_), std::move(triangles), posy_};
  }

 private:
  int turned(int rotation) const { return rotation < posy_ ? rotation : rotation - posy_; }

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

  template <typename Body>
  void for_each_zero_edge(const Body& body) {
    for (Index i = 0; i < graph_.size(); ++i) {
      if (!is_free_[i]) continue;
      for (Index e = graph_.offsets[i]; e < graph_.offsets[i + 1]; ++e) {
        const Index j = graph_.neighbors[e];
        if (j > i && is_free_[j]) body(i, j, rotations_[e]);
      }
    }
  }

  /// The lower one is the root, so that clusters do not depend on the order of the edges.
  void unite() {
    for_each_zero_edge([&](Index i, Index j, std::uint8_t rotation) {
      if (rotation == not_zero) return;
      const Index a = find(i), b = find(j);
      if (a == b) return;
      const int between = turned(turned(rotation_[i] + rotation) + posy_ - rotation_[j]);
      if (a < b) {
        parent_[b] = a;
        rotation_[b] = static_cast<std::uint8_t>(between);
      } else {
        parent_[a] = b;
        rotation_[a] = static_cast<std::uint8_t>(turned(posy_ - between));
      }
    });
    for (Index i = 0; i < graph_.size(); ++i) find(i);  // from here on roots are one step away
  }

  /// Clusters with other jumps inside, or around a singularity of the orientation field.
  void reject_contradictions() {
    for_each_zero_edge([&](Index i, Index j, std::uint8_t rotation) {
      if (parent_[i] != parent_[j]) return;
      if (rotation == not_zero || turned(rotation_[i] + rotation) != rotation_[j]) {
        is_bad_[parent_[i]] = 1;
      }
    });
  }

  /// A connected part of a surface, and not all of it, is a disk if its Euler number is 1.
  void reject_other_than_disks() {
    std::vector<int> euler(graph_.size(), 0);
    for (Index i = 0; i < graph_.size(); ++i) ++euler[parent_[i]];
    for_each_zero_edge([&](Index i, Index j, std::uint8_t) {
      if (parent_[i] == parent_[j]) --euler[parent_[i]];
    });
    for (std::size_t f = 0; f < surface_.faces.size(); ++f) {
      const auto face = surface_.faces[f];
      const Index root = parent_[face[0]];
      if (parent_[face[1]] == root && parent_[face[2]] == root) ++euler[root];
    }
    for (Index i = 0; i < graph_.size(); ++i) {
      if (parent_[i] == i && euler[i] != 1) is_bad_[i] = 1;
    }
  }

  /// The vertices of rejected clusters are alone again.
  void leave_rejected() {
    for (Index i = static_cast<Index>(graph_.size()); i-- > 0;) {  // roots, which are lower, last
      if (!is_bad_[parent_[i]]) continue;
      parent_[i] = i;
      rotation_[i] = 0;
    }
    std::ranges::fill(is_bad_, 0);
  }

  std::vector<std::array<Index, 3>> between_clusters() const {
    std::vector<std::array<Index, 3>> triangles;
    for (std::size_t f = 0; f < surface_.faces.size(); ++f) {
      const auto face = surface_.faces[f];
      const Index a = parent_[face[0]], b = parent_[face[1]], c = parent_[face[2]];
      if (a != b && b != c && c != a) triangles.push_back({face[0], face[1], face[2]});
    }
    return triangles;
  }

  /// Clusters around which the others would not be a simple loop. Returns whether there are any.
  bool reject_folds(const std::vector<std::array<Index, 3>>& triangles) {
    // The triangles' edges by the cluster where they start.
    std::vector<Index> offsets(graph_.size() + 1, 0), ends(3 * triangles.size());
    for (const auto& triangle : triangles) {
      for (const Index v : triangle) ++offsets[parent_[v]];
    }
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    for (const auto& triangle : triangles) {
      for (int k = 0; k < 3; ++k) {
        ends[--offsets[parent_[triangle[k]]]] = parent_[triangle[(k + 1) % 3]];
      }
    }
    bool any = false;
    const auto reject = [&](Index root) {
      if (!has_members(root)) return;
      is_bad_[root] = 1;
      any = true;
    };
    for (Index i = 0; i < graph_.size(); ++i) {
      const std::span<Index> loop{ends.data() + offsets[i], offsets[i + 1] - offsets[i]};
      if (parent_[i] == i && loop.size() < 3) reject(i);
      std::ranges::sort(loop);
      for (std::size_t k = 1; k < loop.size(); ++k) {
        if (loop[k] != loop[k - 1]) continue;
        reject(i);
        reject(loop[k]);
      }
    }
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
  std::vector<Index> parent_;
  std::vector<std::uint8_t> rotation_;  // of each vertex: from its parent's frame to its own
  std::vector<std::uint8_t> is_bad_;    // of each root
};

/// Roots become the members that are nearest to the lattice point.
void put_roots_in_the_middle(DiskClusters& disks, const Graph& graph,
                             const PositionField& position) {
  std::vector<Index> middle(graph.size());  // of each root
  std::iota(middle.begin(), middle.end(), Index{0});
  const auto distance = [&](Index i) {
    return (position.points[i] - graph.positions[i]).squaredNorm();
  };
  for (Index i = 0; i < graph.size(); ++i) {
    Index& best = middle[disks.root[i]];
    if (distance(i) < distance(best)) best = i;
  }
  const std::vector<std::uint8_t> from_old = disks.rotation;
  for (Index i = 0; i < graph.size(); ++i) {
    Index& root = disks.root[i];
    const int turn = from_old[i] + disks.posy - from_old[middle[root]];
    disks.rotation[i] = static_cast<std::uint8_t>(turn % disks.posy);
    root = middle[root];
  }
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
  context.for_ranges(graph.size(), 2048, [&](std::size_t begin, std::size_t end) {
    std::vector<std::array<Index, 2>> rim;
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      is_free[v] = is_free[v] && is_inside(surface, around[v], v, rim);
    }
  });
  const std::vector<std::uint8_t> rotations =
      zero_jumps(graph, orientation, position, energy, is_free, context);
  DiskClusters disks = DiskSearch(surface, graph, position.posy, rotations, is_free).run();
  put_roots_in_the_middle(disks, graph, position);
  return disks;
}

}  // namespace meshgrain
