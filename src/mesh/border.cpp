#include "mesh/border.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/find_rings.h"
#include "mesh/vertex_faces.h"
#include "mesh/vertex_ring.h"
#include "util/collect.h"

namespace meshgrain {
namespace {

/// The faces of an edge: how many run along it in either direction, and one of each; or if there
/// are only two and they run in the same direction, these.
struct EdgeFaces {
  int forth = 0, back = 0;
  Index left = no_index, right = no_index;

  void add(Index face, bool runs_forth) {
    ++(runs_forth ? forth : back);
    Index &own = runs_forth ? left : right, &other = runs_forth ? right : left;
    if (forth + back == 2 && own != no_index) other = own;
    own = face;
  }
};

/// Calls `take(a, b, faces)` for the edges from vertex a to others b > a.
class EdgesOfVertex {
 public:
  template <typename Take>
  void visit(const Mesh& mesh, std::span<const Index> around, Index a, const Take& take) {
    if (mesh.faces.uniform_degree() == 3 && ring_.find(mesh, around, a)) {
      const std::span<const Index> neighbors = ring_.neighbors();
      const auto lower = std::ranges::count_if(neighbors, [&](Index b) { return b < a; });
      for (auto k = static_cast<std::size_t>(lower); k < neighbors.size(); ++k) {
        take(a, neighbors[k], EdgeFaces{1, 1, around[ring_.left(k)], around[ring_.right(k)]});
      }
    } else {
      visit_any(mesh, around, a, take);
    }
  }

 private:
  struct Use {
    Index other, face;
    bool forth;
  };

  template <typename Take>
  void visit_any(const Mesh& mesh, std::span<const Index> around, Index a, const Take& take) {
    uses_.clear();
    for (const Index f : around) {
      const auto face = mesh.faces[f];
      Index from = face.back();
      for (const Index to : face) {
        if (from == a && to > a) uses_.push_back({to, f, true});
        if (to == a && from > a) uses_.push_back({from, f, false});
        from = to;
      }
    }
    std::sort(uses_.begin(), uses_.end(),
              [](const Use& x, const Use& y) { return x.other < y.other; });
    for (std::size_t k = 0; k < uses_.size();) {
      EdgeFaces faces;
      const Index b = uses_[k].other;
      for (; k < uses_.size() && uses_[k].other == b; ++k) {
        faces.add(uses_[k].face, uses_[k].forth);
      }
      take(a, b, faces);
    }
  }

  VertexRing ring_;
  std::vector<Use> uses_;
};

/// For collect(): calls `take(a, b, faces, out)` for every edge a < b.
template <typename Take>
auto each_edge(const Mesh& mesh, const VertexFaces& around, const Take& take) {
  return [&](std::size_t begin, std::size_t end, auto& out) {
    EdgesOfVertex edges;
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      edges.visit(mesh, around[v], v,
                  [&](Index a, Index b, const EdgeFaces& faces) { take(a, b, faces, out); });
    }
  };
}

/// The same without the edges of vertices that are rings, of which those that are sharp go to
/// `sharp`.
template <typename Take>
void visit_odd_edges(const Mesh& mesh, const VertexFaces& around, std::size_t begin,
                     std::size_t end, SharpSearch* sharp, const Take& take) {
  std::vector<std::uint8_t> is_ring(end - begin, 0);
  if (mesh.faces.uniform_degree() == 3) find_rings(mesh, around, begin, is_ring, sharp);
  EdgesOfVertex edges;
  for (auto v = static_cast<Index>(begin); v < end; ++v) {
    if (!is_ring[v - begin]) edges.visit(mesh, around[v], v, take);
  }
}

template <typename Selected, typename Take>
std::vector<Selected> select_edges(const Mesh& mesh, const Take& take, const Context& context) {
  const VertexFaces around = vertex_faces(mesh, context);
  return collect<Selected>(mesh.positions.size(), each_edge(mesh, around, take), context);
}

template <typename Selected, typename Take>
std::vector<Selected> select_odd_edges(const Mesh& mesh, const Take& take, const Context& context) {
  const VertexFaces around = vertex_faces(mesh, context);
  const auto visit = [&](std::size_t begin, std::size_t end, std::vector<Selected>& out) {
    visit_odd_edges(mesh, around, begin, end, nullptr,
                    [&](Index a, Index b, const EdgeFaces& faces) { take(a, b, faces, out); });
  };
  return collect<Selected>(mesh.positions.size(), visit, context);
}

using Edge = std::array<Index, 2>;
using Edges = std::vector<Edge>;

}  // namespace

std::vector<std::uint8_t> mark_ends(std::span<const std::array<Index, 2>> edges,
                                    std::size_t vertices) {
  std::vector<std::uint8_t> result(vertices, 0);
  for (const auto& [a, b] : edges) result[a] = result[b] = 1;
  return result;
}

std::vector<std::uint8_t> rim_vertices(const Mesh& mesh, const Context& context) {
  return mark_ends(rim_edges(mesh, context), mesh.positions.size());
}

std::vector<std::array<Index, 2>> border_edges(const Mesh& mesh, const Context& context) {
  return select_odd_edges<Edge>(
      mesh,
      [](Index a, Index b, const EdgeFaces& faces, Edges& out) {
        if (faces.forth + faces.back != 1) return;
        out.push_back(faces.forth == 1 ? std::array{a, b} : std::array{b, a});
      },
      context);
}

std::vector<std::array<Index, 2>> rim_edges(const Mesh& mesh, const Context& context) {
  return select_odd_edges<Edge>(
      mesh,
      [](Index a, Index b, const EdgeFaces& faces, Edges& out) {
        if (faces.forth != 1 || faces.back != 1) out.push_back({a, b});
      },
      context);
}

std::vector<RimEdge> classified_rim(const Mesh& mesh, const Context& context) {
  return select_odd_edges<RimEdge>(
      mesh,
      [](Index a, Index b, const EdgeFaces& faces, std::vector<RimEdge>& out) {
        if (faces.forth == 1 && faces.back == 1) return;
        out.push_back({{a, b}, faces.forth + faces.back == 1});
      },
      context);
}

std::vector<std::array<Index, 2>> branch_edges(const Mesh& mesh, const Context& context) {
  Edges result;
  for (const auto& [ends, is_border] : classified_rim(mesh, context)) {
    if (!is_border) result.push_back(ends);
  }
  return result;
}

std::vector<InnerEdge> inner_edges(const Mesh& mesh,
                                   const std::function<bool(const InnerEdge&)>& wanted,
                                   const Context& context) {
  return select_edges<InnerEdge>(
      mesh,
      [&](Index a, Index b, const EdgeFaces& faces, std::vector<InnerEdge>& out) {
        if (faces.forth != 1 || faces.back != 1) return;
        const InnerEdge edge{{a, b}, faces.left, faces.right};
        if (wanted(edge)) out.push_back(edge);
      },
      context);
}

std::vector<TwoFacedEdge> two_faced_edges(const Mesh& mesh, const Context& context) {
  return select_edges<TwoFacedEdge>(
      mesh,
      [](Index a, Index b, const EdgeFaces& faces, std::vector<TwoFacedEdge>& out) {
        if (faces.forth + faces.back != 2) return;
        out.push_back({{a, b}, {faces.left, faces.right}, faces.forth == 1});
      },
      context);
}

bool disagree_somewhere(const Mesh& mesh, const Context& context) {
  const auto disagreeing = select_odd_edges<Edge>(
      mesh,
      [](Index a, Index b, const EdgeFaces& faces, Edges& out) {
        if (faces.forth + faces.back == 2 && faces.forth != 1) out.push_back({a, b});
      },
      context);
  return !disagreeing.empty();
}

double sharp_cosine(double degrees) {
  return degrees < 0 ? 2 : std::cos(degrees * std::numbers::pi / 180);
}

RimAndSharpEdges rim_and_sharp_edges(const Mesh& mesh, double degrees, const Context& context) {
  // Unit normals of the faces, or zero.
  std::vector<Vec3> normals(mesh.faces.size());
  context.for_ranges(normals.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto face = mesh.faces[f];
      Vec3 sum = Vec3::Zero();
      for (std::size_t k = 2; k < face.size(); ++k) {
        sum += (mesh.positions[face[k - 1]] - mesh.positions[face[0]])
                   .cross(mesh.positions[face[k]] - mesh.positions[face[0]]);
      }
      const float length = sum.norm();
      normals[f] = length > 0 ? Vec3(sum / length) : Vec3(Vec3::Zero());
    }
  });
  struct Found {
    Edges rim;
    std::vector<SharpEdge> sharp;
  };
  const VertexFaces around = vertex_faces(mesh, context);
  const auto find = [&](std::size_t begin, std::size_t end, Found& out) {
    SharpSearch search{normals, sharp_cosine(degrees), out.sharp};
    const auto take = [&](Index a, Index b, const EdgeFaces& faces) {
      if (faces.forth != 1 || faces.back != 1) return out.rim.push_back({a, b});
      search.look_at({a, b}, faces.left, faces.right);
    };
    visit_odd_edges(mesh, around, begin, end, &search, take);
    // Those at rings came first.
    std::ranges::sort(out.sharp, {}, &SharpEdge::ends);
  };
  const auto parts = collect_parts<Found>(mesh.positions.size(), find, context);
  RimAndSharpEdges result;
  for (const Found& found : parts) {
    result.rim.insert(result.rim.end(), found.rim.begin(), found.rim.end());
  }
  result.sharp = joined<SharpEdge>(
      parts, [](const Found& found) { return std::span(found.sharp); }, context);
  return result;
}

UninitializedVector<SharpEdge> sharp_edges(const Mesh& mesh, double degrees,
                                           const Context& context) {
  return rim_and_sharp_edges(mesh, degrees, context).sharp;
}

std::vector<std::array<Index, 2>> crease_edges(const Mesh& mesh, double degrees,
                                               const Context& context) {
  Edges result;
  for (const SharpEdge& edge : sharp_edges(mesh, degrees, context)) result.push_back(edge.ends);
  return result;
}

}  // namespace meshgrain
