#include "tunnels/close_tunnels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "measure/crossings.h"
#include "mesh/keep_vertices.h"
#include "mesh/pieces.h"
#include "mesh/vertex_faces.h"
#include "tunnels/loop_length.h"
#include "tunnels/loop_search.h"
#include "tunnels/tunnel.h"
#include "util/edge_of.h"
#include "util/sort_unique.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

struct Loop {
  double length;
  std::vector<Index> vertices;
  auto operator<=>(const Loop&) const = default;
};

struct Tunnel {
  double loop;  // the length of a loop around it
  Sleeve sleeve;
};

/// A new vertex in the middle of a rim, joined to all of that.
void put_lid_on(Mesh& mesh, const std::vector<Index>& rim) {
  Vec3 middle = Vec3::Zero();
  for (const Index v : rim) middle += mesh.positions[v] / static_cast<float>(rim.size());
  const auto center = static_cast<Index>(mesh.positions.size());
  mesh.positions.push_back(middle);
  if (!mesh.values.empty()) mesh.values.push_back(mesh.values[rim[0]]);
  for (std::size_t k = 0; k < rim.size(); ++k) {
    mesh.faces.push_back({rim[k], rim[(k + 1) % rim.size()], center});
  }
}

/// The edges of some faces, each once.
std::vector<std::array<Index, 2>> edges_of(const Mesh& mesh, std::span<const Index> faces) {
  std::vector<std::array<Index, 2>> edges;
  for (const Index f : faces) {
    const auto corners = mesh.faces[f];
    for (std::size_t k = 0; k < 3; ++k) {
      edges.push_back(edge_of(corners[k], corners[(k + 1) % 3]));
    }
  }
  sort_unique(edges);
  return edges;
}

/// Puts two lids in the place of each sleeve, and forgets marks of edges that are gone.
void close(Mesh& mesh, std::span<const Tunnel> tunnels) {
  std::vector<Index> gone;
  std::vector<std::array<Index, 2>> stay;
  for (const auto& [loop, sleeve] : tunnels) {
    gone.insert(gone.end(), sleeve.faces.begin(), sleeve.faces.end());
    for (const auto& rim : sleeve.rims) {
      for (std::size_t k = 0; k < rim.size(); ++k) {
        stay.push_back(edge_of(rim[k], rim[(k + 1) % rim.size()]));
      }
    }
  }
  std::ranges::sort(gone);
  std::ranges::sort(stay);
  const auto edges = edges_of(mesh, gone);
  std::erase_if(mesh.marked_edges, [&](const auto& mark) {
    const auto edge = edge_of(mark[0], mark[1]);
    return std::ranges::binary_search(edges, edge) && !std::ranges::binary_search(stay, edge);
  });
  Faces kept;
  kept.reserve(mesh.faces.size(), 3 * mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!std::ranges::binary_search(gone, f)) kept.push_back(std::as_const(mesh.faces)[f]);
  }
  mesh.faces = std::move(kept);
  mesh.normals.clear();
  for (const auto& [loop, sleeve] : tunnels) {
    for (const auto& rim : sleeve.rims) put_lid_on(mesh, rim);
  }
}

/// The vertices around the lids of some tunnels.
std::vector<Index> rims_of(std::span<const Tunnel> tunnels) {
  std::vector<Index> vertices;
  for (const Tunnel& tunnel : tunnels) {
    for (const auto& rim : tunnel.sleeve.rims) {
      vertices.insert(vertices.end(), rim.begin(), rim.end());
    }
  }
  return vertices;
}

/// The loops near some vertices that are not longer than that, the shortest first.
std::vector<Loop> find_loops(const Mesh& mesh, const VertexFaces& around,
                             std::span<const Index> near, double longest, const Context& context) {
  // What `take` makes of the loops near some of the places, which lie so far apart.
  const auto look_from = [&]<typename Taken>(std::span<const Index> places, double apart,
                                             double beyond, const auto& take,
                                             std::vector<Taken>& all) {
    const std::vector<Index> some = LoopSearch(mesh, around).thinned_out(places, apart);
    std::vector<std::vector<Taken>> taken(some.size());
    constexpr std::size_t grain = 64;
    context.for_ranges(some.size(), grain, [&](std::size_t begin, std::size_t end) {
      LoopSearch search(mesh, around);
      for (std::size_t k = begin; k < end; ++k) {
        context.check();
        for (auto& loop : search.near(some[k], beyond, longest)) take(std::move(loop), taken[k]);
      }
    });
    for (auto& part : taken) std::ranges::move(part, std::back_inserter(all));
    sort_unique(all);
  };
  using Vertices = std::vector<Index>;
  // From a few places it shows where there are any, and from there, which are the shortest.
  std::vector<Index> there;
  const auto take_place = [](Vertices&& loop, Vertices& taken) { taken.push_back(loop.front()); };
  look_from(near, longest / 4, longest / 4, take_place, there);
  std::vector<Loop> loops;
  const auto take_loop = [&](Vertices&& loop, std::vector<Loop>& taken) {
    const double length = loop_length(loop, mesh.positions);
    if (length <= longest) taken.push_back({length, std::move(loop)});
  };
  look_from(there, longest / 32, 0, take_loop, loops);
  return loops;
}

/// Whether the lids of a sleeve would pass through other pieces of the surface, as where a pin is
/// in a hole, or a chain has its next link. `pieces`: of vertices.
bool passes_through_others(const Mesh& mesh, const Sleeve& sleeve, UnionFind& pieces,
                           const Context& context) {
  Eigen::AlignedBox3f box;
  for (const auto& rim : sleeve.rims) {
    for (const Index v : rim) box.extend(mesh.positions[v]);
  }
  Mesh near;
  const Index piece = pieces.find(sleeve.rims[0][0]);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (pieces.find(mesh.faces[f][0]) == piece) continue;
    if (face_box(mesh, f).intersects(box)) near.faces.push_back(mesh.faces[f]);
  }
  if (near.faces.empty()) return false;
  std::vector<Index> lids(sleeve.rims[0].size() + sleeve.rims[1].size());
  std::iota(lids.begin(), lids.end(), static_cast<Index>(near.faces.size()));
  near.positions = mesh.positions;
  for (const auto& rim : sleeve.rims) put_lid_on(near, rim);
  return count_crossings_of(near, lids, context) > 0;
}

/// Tunnels without a vertex in common, those of the shortest loops first.
std::vector<Tunnel> find_tunnels(const Mesh& mesh, TunnelSearch::Kind kind,
                                 std::span<const Index> near, double longest,
                                 const Context& context) {
  const VertexFaces around = vertex_faces(mesh, context);
  SleeveCutter cutter(mesh, around);
  TunnelSearch search(mesh, around, cutter);
  UnionFind pieces = pieces_of(mesh);
  std::vector<Tunnel> tunnels;
  for (const Loop& loop : find_loops(mesh, around, near, longest, context)) {
    context.check();
    std::optional<Sleeve> sleeve = search.sleeve_around(loop.vertices, kind, longest);
    if (!sleeve || passes_through_others(mesh, *sleeve, pieces, context)) continue;
    cutter.cut_out(*sleeve);
    tunnels.push_back({loop.length, std::move(*sleeve)});
  }
  return tunnels;
}

}  // namespace

std::size_t close_tunnels(Mesh& triangles, std::span<const Index> near, double longest,
                          const Context& context) {
  using enum TunnelSearch::Kind;
  double longest_closed = 0;
  const auto close_all = [&](Mesh& mesh, TunnelSearch::Kind kind, std::span<const Index> seeds,
                             double most) {
    constexpr int most_rounds = 8;
    std::size_t count = 0;
    std::vector<Tunnel> tunnels = find_tunnels(mesh, kind, seeds, most, context);
    for (int round = 0; round < most_rounds && !tunnels.empty(); ++round) {
      close(mesh, tunnels);
      count += tunnels.size();
      for (const Tunnel& tunnel : tunnels) longest_closed = std::max(longest_closed, tunnel.loop);
      // Others can have become possible beside these alone.
      tunnels = find_tunnels(mesh, kind, rims_of(tunnels), most, context);
    }
    return count;
  };
  std::size_t count = close_all(triangles, hollow, near, longest);
  if (count > 0) {
    Mesh without_others = triangles;
    std::vector<Index> all(triangles.positions.size());
    std::iota(all.begin(), all.end(), Index{0});
    constexpr double alike = 1.1;
    const double most = std::min(longest, alike * longest_closed);
    const std::size_t others = close_all(without_others, hollow, all, most);
    if (others <= count) {
      triangles = std::move(without_others);
      count += others;
    }
  }
  // What is left between holes side by side is a short handle, too, until these are closed.
  count += close_all(triangles, handle, near, longest / 2);
  if (count > 0) drop_unused_vertices(triangles, context);
  return count;
}

}  // namespace meshgrain
