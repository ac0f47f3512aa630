#include "border/lock_borders.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "border/border_faces.h"
#include "border/border_slots.h"
#include "border/collar.h"
#include "border/match_loop.h"
#include "extract/collect_faces.h"
#include "extract/extraction_map.h"
#include "extract/face_repair.h"

namespace meshgrain {
namespace {

class BorderLock {
 public:
  BorderLock(ExtractionMap& mesh, const BorderLoops& borders, const Graph& graph, OutputFaces faces)
      : mesh_(mesh), map_(mesh.map), borders_(borders), graph_(graph), faces_(faces) {}

  void run() {
    find_rims();
    for (Rim& rim : rims_) {
      if (rim.loop != no_index) lock(rim);
    }
    const bool triangles = faces_ == OutputFaces::triangles;
    BorderFaces faces(mesh_, triangles ? BorderFaces::Kind::triangles : BorderFaces::Kind::quads);
    faces.mend();
    faces.improve();
  }

  /// Borders with too many vertices, none of which could go.
  std::vector<Collar> collars(const std::vector<Index>& vertex) const {
    std::vector<Collar> result;
    for (const Rim& rim : rims_) {
      if (!rim.needs_collar) continue;
      Collar collar;
      const BorderLoop& loop = borders_.loops[rim.loop];
      for (const BorderPoint& point : points_of(rim)) collar.inner_places.push_back(point.place);
      for (const Index h : rim.halfedges) collar.inner.push_back(vertex[map_.origin(h)]);
      collar.outer_places = rim.slots;
      collar.period = static_cast<double>(loop.locked.size());
      for (const double slot : rim.slots) {
        collar.outer_nodes.push_back(loop.locked[static_cast<std::size_t>(slot)]);
      }
      result.push_back(std::move(collar));
    }
    return result;
  }

 private:
  /// A border of the extracted mesh, as halfedges of the hole.
  struct Rim {
    std::vector<Index> halfedges;
    Index loop = no_index;
    Slots slots;
    bool needs_collar = false;
  };

  /// The borders, each with the one of the surface that most of its vertices are on.
  void find_rims() {
    std::vector<std::uint8_t> seen(map_.halfedges(), 0);
    struct Vote {
      std::size_t count;
      Index rim, loop;
    };
    std::vector<Vote> votes;
    for (Index h = 0; h < map_.halfedges(); ++h) {
      if (!mesh_.holes[h] || seen[h]) continue;
      Rim rim;
      map_.orbit(h, rim.halfedges);
      std::map<Index, std::size_t> counts;
      for (const Index g : rim.halfedges) {
        seen[g] = 1;
        for (const auto& place : places_of(g)) ++counts[place.loop];
      }
      for (const auto& [loop, count] : counts) {
        votes.push_back({count, static_cast<Index>(rims_.size()), loop});
      }
      rims_.push_back(std::move(rim));
    }
    std::ranges::stable_sort(votes, std::ranges::greater(), &Vote::count);
    std::vector<std::uint8_t> taken(borders_.loops.size(), 0);
    for (const Vote& vote : votes) {
      if (taken[vote.loop] || rims_[vote.rim].loop != no_index) continue;
      rims_[vote.rim].loop = vote.loop;
      taken[vote.loop] = 1;
    }
  }

  std::span<const BorderLoops::Place> places_of(Index h) const {
    return borders_.places_of(mesh_.clusters.nodes[map_.origin(h)]);
  }

  /// Where the vertices of a rim are, in order around it.
  std::vector<BorderPoint> points_of(const Rim& rim) const {
    constexpr double of_corner = 20;
    const double whole = period(rim);
    std::vector<BorderPoint> points;
    double around = 0;
    for (const Index h : rim.halfedges) {
      const bool corner = mesh_.clusters.hold[map_.origin(h)] == at_corner;
      double place = points.empty() ? 0 : points.back().place;
      for (const auto& p : places_of(h)) {
        if (p.loop != rim.loop) continue;
        const double step = points.empty() ? p.place : std::remainder(p.place - place, whole);
        place += step;
        if (!points.empty()) around += step;
        break;
      }
      points.push_back({place, corner ? of_corner : 1});
    }
    around += std::remainder(points[0].place - points.back().place, whole);
    if (std::abs(around - whole) < 0.5) return points;
    // Out of order: evenly.
    for (std::size_t k = 0; k < points.size(); ++k) {
      points[k] = {whole * static_cast<double>(k) / static_cast<double>(points.size()), 1};
    }
    return points;
  }

  void lock(Rim& rim) {
    LoopMatch match = choose_slots(rim);
    if (!merge(rim, match)) {
      if (rim.halfedges.size() > rim.slots.size()) {
        rim.needs_collar = true;
        return;
      }
      match = match_apart(points_of(rim), rim.slots, period(rim));
    }
    add_missing(rim, match);
    for (std::size_t k = 0; k < rim.halfedges.size(); ++k) {
      const Index v = map_.origin(rim.halfedges[k]);
      const Index node = node_of(rim, match.slots[0] + static_cast<std::ptrdiff_t>(k));
      mesh_.clusters.nodes[v] = node;
      mesh_.clusters.positions[v] = graph_.positions[node];
      mesh_.clusters.normals[v] = graph_.normals[node];
      mesh_.clusters.hold[v] = at_corner;
    }
  }

  double period(const Rim& rim) const {
    return static_cast<double>(borders_.loops[rim.loop].locked.size());
  }

  Index node_of(const Rim& rim, std::ptrdiff_t slot) const {
    const auto count = std::ssize(rim.slots);
    const auto k = static_cast<std::size_t>(((slot % count) + count) % count);
    return borders_.loops[rim.loop].locked[static_cast<std::size_t>(rim.slots[k])];
  }

  LoopMatch choose_slots(Rim& rim) const {
    const std::vector<BorderPoint> points = points_of(rim);
    LoopMatch best;
    for (Slots& slots : slot_choices(borders_.loops[rim.loop], points, graph_, faces_)) {
      LoopMatch found = match_loop(points, slots, period(rim));
      if (!rim.slots.empty() && found.cost >= best.cost) continue;
      best = std::move(found);
      rim.slots = std::move(slots);
    }
    return best;
  }

  /// Merges vertices that have the same slot. Returns whether all of them could be.
  bool merge(Rim& rim, LoopMatch& match) {
    bool all = true;
    const auto count = std::ssize(rim.slots);
    for (std::size_t k = 0; k < rim.halfedges.size();) {
      const bool last = k + 1 == rim.halfedges.size();
      const std::ptrdiff_t next = last ? match.slots[0] + count : match.slots[k + 1];
      if (match.slots[k] != next || rim.halfedges.size() <= 3) {
        all = all && match.slots[k] != next;
        ++k;
        continue;
      }
      if (!contract(rim.halfedges[k])) {
        all = false;
        ++k;
        continue;
      }
      // The halfedge that is left out begins at the vertex that stays.
      rim.halfedges.erase(rim.halfedges.begin() + static_cast<std::ptrdiff_t>(k));
      if (last) {
        match.slots.pop_back();
      } else {
        match.slots.erase(match.slots.begin() + static_cast<std::ptrdiff_t>(k + 1));
      }
    }
    return all;
  }

  /// Contracts an edge of a hole, if the topology allows that.
  bool contract(Index h) {
    const Index t = PolygonMap::twin(h), a = map_.origin(h), b = map_.target(h);
    if (mesh_.holes[t]) return false;
    const bool triangle = map_.degree(t) == 3;
    const Index apex = triangle ? map_.origin(map_.prev(t)) : no_index;
    if (triangle) {
      const bool inner = !mesh_.clusters.on_border[apex];
      if (inner && map_.valence(apex) <= 3) return false;
      const Index beside[2] = {PolygonMap::twin(map_.next(t)), PolygonMap::twin(map_.prev(t))};
      if (mesh_.holes[beside[0]] && mesh_.holes[beside[1]]) return false;
    }
    // No other face or edge has both of them or would get the other twice.
    for (Index g = map_.around(h); g != h; g = map_.around(g)) {
      const Index v = map_.target(g);
      if (v != apex && map_.adjacent(v, b)) return false;
      if (mesh_.holes[g] || g == map_.next(t)) continue;
      for (Index k = map_.next(g); k != g; k = map_.next(k)) {
        if (map_.origin(k) == b) return false;
      }
    }
    // What stays is the one that matters more.
    const bool keep_b = mesh_.clusters.hold[b] > mesh_.clusters.hold[a];
    const Index gone = map_.next(t), kept = map_.prev(t);
    map_.contract_edge(h);
    if (triangle) {
      if (mesh_.lines[kept / 2] == no_index) mesh_.lines[kept / 2] = mesh_.lines[gone / 2];
      mesh_.holes[kept] = mesh_.holes[PolygonMap::twin(gone)];
      const Index hole = PolygonMap::twin(gone);
      if (mesh_.holes[hole]) replace_in_rims(hole, kept);
      map_.remove_edge(gone);
    }
    if (keep_b) {
      mesh_.clusters.hold[a] = mesh_.clusters.hold[b];
      mesh_.clusters.nodes[a] = mesh_.clusters.nodes[b];
      mesh_.clusters.positions[a] = mesh_.clusters.positions[b];
    }
    return true;
  }

  void replace_in_rims(Index from, Index to) {
    for (Rim& rim : rims_) std::ranges::replace(rim.halfedges, from, to);
  }

  /// Puts a vertex into the rim for each slot that has none.
  void add_missing(Rim& rim, const LoopMatch& match) {
    std::vector<Index> all;
    const auto count = std::ssize(rim.slots);
    for (std::size_t k = 0; k < rim.halfedges.size(); ++k) {
      const bool last = k + 1 == rim.halfedges.size();
      const std::ptrdiff_t next = last ? match.slots[0] + count : match.slots[k + 1];
      Index h = rim.halfedges[k];
      all.push_back(h);
      for (std::ptrdiff_t slot = match.slots[k] + 1; slot < next; ++slot) {
        const Index line = mesh_.lines[h / 2];
        h = map_.split_edge(h);
        all.push_back(h);
        mesh_.holes.push_back(1);
        mesh_.holes.push_back(0);
        mesh_.lines.push_back(line);
        append_vertex(mesh_.clusters, node_of(rim, slot));
      }
    }
    rim.halfedges = std::move(all);
  }

  void append_vertex(Clusters& clusters, Index node) const {
    clusters.positions.push_back(graph_.positions[node]);
    clusters.normals.push_back(graph_.normals[node]);
    clusters.nodes.push_back(node);
    clusters.on_border.push_back(1);
    clusters.hold.push_back(at_corner);
  }

  ExtractionMap& mesh_;
  PolygonMap& map_;
  const BorderLoops& borders_;
  const Graph& graph_;
  OutputFaces faces_;
  std::vector<Rim> rims_;
};

/// The mesh of a map, and for each vertex of the map that of the mesh.
std::vector<Index> collect(ExtractionMap& mesh, Extraction& extraction, const Context& context) {
  constexpr int any_posy = 4;
  FaceRepair repair(mesh.map, mesh.clusters, any_posy, std::move(mesh.holes),
                    std::move(mesh.lines));
  std::vector<Index> vertex;
  extraction = collect_faces(mesh.map, repair, mesh.clusters, vertex, context);
  return vertex;
}

}  // namespace

void lock_borders(Extraction& extraction, const BorderLoops& borders, const Graph& graph,
                  OutputFaces faces, const Context& context) {
  if (borders.empty()) return;
  ExtractionMap mesh(extraction, context);
  BorderLock lock(mesh, borders, graph, faces);
  lock.run();
  const std::vector<Index> vertex = collect(mesh, extraction, context);
  for (const Collar& collar : lock.collars(vertex)) {
    add_collar(extraction, collar, graph, faces != OutputFaces::triangles);
  }
}

bool improve_border_faces(Extraction& extraction, OutputFaces faces, const Context& context) {
  const auto kind = faces == OutputFaces::triangles ? BorderFaces::Kind::triangles
                    : faces == OutputFaces::quads   ? BorderFaces::Kind::only_quads
                                                    : BorderFaces::Kind::quads;
  ExtractionMap mesh(extraction, context);
  if (mesh.map.vertices() != extraction.mesh.positions.size()) return false;
  if (!BorderFaces(mesh, kind).improve()) return false;
  collect(mesh, extraction, context);
  return true;
}

}  // namespace meshgrain
