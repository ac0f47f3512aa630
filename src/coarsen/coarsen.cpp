#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "coarsen/collapsing_piece.h"
#include "mesh/keep_vertices.h"
#include "meshgrain/surface.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

using Triangle = CollapsingPiece::Triangle;

/// Faces that are collapsed together: as many as a processor's own cache has room for.
constexpr std::size_t faces_a_run = 32768;

constexpr Index on_seam = no_index - 1;

/// For each vertex the run of its faces, or `on_seam` if there are several.
std::vector<Index> runs_of_vertices(const Mesh& mesh, const Context& context) {
  std::vector<Index> result(mesh.positions.size(), no_index);
  const auto corners = mesh.faces.corners();
  context.for_ranges(mesh.faces.size(), faces_a_run, [&](std::size_t begin, std::size_t end) {
    const auto run = static_cast<Index>(begin / faces_a_run);
    for (std::size_t c = 3 * begin; c < 3 * end; ++c) {
      const std::atomic_ref<Index> of_vertex(result[corners[c]]);
      Index before = of_vertex.load(std::memory_order_relaxed);
      if (before == no_index) {
        of_vertex.compare_exchange_strong(before, run, std::memory_order_relaxed);
      }
      if (before != no_index && before != run) {
        of_vertex.store(on_seam, std::memory_order_relaxed);
      }
    }
  });
  return result;
}

/// All runs of faces, each collapsed by itself.
class Round {
 public:
  Round(Mesh& mesh, const CoarseEdges& edges, std::vector<std::uint8_t>& stays,
        const Context& context)
      : mesh_(mesh),
        edges_(edges),
        stays_(stays),
        context_(context),
        runs_(runs_of_vertices(mesh, context)),
        place_(mesh.positions.size(), no_index),
        is_gone_(mesh.positions.size(), 0),
        on_seams_(static_cast<std::size_t>(std::ranges::count(runs_, on_seam))) {}

  /// Returns the vertices that are left.
  std::vector<Index> run() {
    std::vector<std::vector<Triangle>> left((mesh_.faces.size() + faces_a_run - 1) / faces_a_run);
    context_.for_ranges(mesh_.faces.size(), faces_a_run, [&](std::size_t begin, std::size_t end) {
      context_.check();
      left[begin / faces_a_run] = collapse(begin, end);
    });
    return compact(left);
  }

  std::size_t on_seams() const { return on_seams_; }

 private:
  /// Of the faces [begin, end).
  std::vector<Triangle> collapse(std::size_t begin, std::size_t end) {
    const auto run = static_cast<Index>(begin / faces_a_run);
    const auto corners = std::as_const(mesh_.faces).corners();
    std::vector<Vec3> positions;
    std::vector<std::uint8_t> is_free;
    std::vector<Index> vertices;
    std::unordered_map<Index, Index> place_on_seam;
    const auto local = [&](Index v) {
      const bool is_own = runs_[v] == run;
      Index& place = is_own ? place_[v] : place_on_seam.try_emplace(v, no_index).first->second;
      if (place == no_index) {
        place = static_cast<Index>(vertices.size());
        vertices.push_back(v);
        positions.push_back(mesh_.positions[v]);
        is_free.push_back(is_own && !stays_[v]);
      }
      return place;
    };
    std::vector<Triangle> triangles(end - begin);
    for (std::size_t f = begin; f < end; ++f) {
      triangles[f - begin] = {local(corners[3 * f]), local(corners[3 * f + 1]),
                              local(corners[3 * f + 2])};
    }
    CollapsingPiece piece(std::move(positions), std::move(is_free), triangles);
    piece.collapse_short_edges(edges_);
    for (Index k = 0; k < vertices.size(); ++k) {
      const Index v = vertices[k];
      if (runs_[v] != run) continue;
      is_gone_[v] = piece.is_gone(k);
      mesh_.positions[v] = piece.positions()[k];
    }
    std::vector<Triangle> left = piece.triangles();
    for (Triangle& triangle : left) {
      for (Index& v : triangle) v = vertices[v];
    }
    return left;
  }

  std::vector<Index> compact(const std::vector<std::vector<Triangle>>& left) {
    std::vector<Index> kept = indices_where(
        is_gone_.size(), [&](Index v) { return !is_gone_[v]; }, context_);
    std::vector<Index>& number = place_;  // which is of no use any more
    for_indices(
        kept.size(), [&](Index k) { number[kept[k]] = k; }, context_);
    keep_vertices(mesh_, kept);
    mesh_.positions.shrink_to_fit();
    for (std::size_t k = 0; k < kept.size(); ++k) stays_[k] = stays_[kept[k]];
    stays_.resize(kept.size());
    for (auto& edge : mesh_.marked_edges) edge = {number[edge[0]], number[edge[1]]};
    std::vector<std::size_t> first(left.size() + 1, 0);
    for (std::size_t r = 0; r < left.size(); ++r) first[r + 1] = first[r] + left[r].size();
    mesh_.faces = {};
    mesh_.faces = Faces::uniform(first.back(), 3);
    Index* const corners = mesh_.faces.corners().data();
    context_.for_ranges(left.size(), 1, [&](std::size_t r, std::size_t) {
      Index* to = corners + 3 * first[r];
      for (const Triangle& triangle : left[r]) {
        for (const Index v : triangle) *to++ = number[v];
      }
    });
    return kept;
  }

  Mesh& mesh_;
  const CoarseEdges& edges_;
  std::vector<std::uint8_t>& stays_;
  const Context& context_;
  std::vector<Index> runs_;   // of each vertex
  std::vector<Index> place_;  // of each vertex in its run
  std::vector<std::uint8_t> is_gone_;
  std::size_t on_seams_;
};

}  // namespace

std::vector<Index> coarsen(Mesh& triangles, const CoarseEdges& edges,
                           std::vector<std::uint8_t> stays, const Context& context) {
  std::vector<Index> kept(triangles.positions.size());
  std::iota(kept.begin(), kept.end(), Index{0});
  // What is on seams now may be inside of a run the next time.
  constexpr double few_on_seams = 0.2, few_gone = 0.05;
  for (;;) {
    Round round(triangles, edges, stays, context);
    const std::vector<Index> left = round.run();
    for (std::size_t k = 0; k < left.size(); ++k) kept[k] = kept[left[k]];
    const auto before = static_cast<double>(kept.size()), after = static_cast<double>(left.size());
    kept.resize(left.size());
    const bool is_done = before - after < few_gone * before;
    if (is_done || static_cast<double>(round.on_seams()) < few_on_seams * after) return kept;
  }
}

}  // namespace meshgrain
