#pragma once

#include "field/carry_fields.h"
#include "field/posy.h"
#include "field/relax_positions.h"
#include "meshgrain/fields.h"
#include "util/hash.h"

namespace meshgrain {

/// One node's part of a position field (section 3.3): the energies of Eq. 5 and 6 for both
/// lattices. The value is the lattice point nearest to the node.
template <int S, PositionEnergy E>
class PositionKernel {
 public:
  using Value = Vec3;
  using Integers = Translations;

  PositionKernel(const Graph& graph, const LatticeFrame& frame, const LineConstraints& constraints,
                 float extent)
      : graph_(&graph), frame_(&frame), constraints_(&constraints), extent_(extent) {}

  /// Somewhere in the tangent plane, as far away as the surface reaches: only the fraction matters.
  Vec3 random(Index i, std::uint64_t hash) const {
    const Vec3& n = graph_->normals[i];
    const Vec3 u = any_tangent(n);
    const float a = unit_float(hash64(hash, 1)) - 0.5f, b = unit_float(hash64(hash, 2)) - 0.5f;
    return nearest(i, graph_->positions[i] + extent_ * (a * u + b * n.cross(u)));
  }

  /// Eq. 7, for nodes that are no neighbours of each other.
  void relax(std::span<const Index> nodes, const Vec3* field, Vec3* values) const {
    relax_positions(*graph_, *frame_, *constraints_, S, E, nodes, field, values);
  }

  double energy(Index i, const Vec3* field) const {
    double sum = 0;
    for (Index e = graph_->offsets[i]; e < graph_->offsets[i + 1]; ++e) {
      sum += graph_->weight(e) * squared_distance(i, e, field, match(i, e, field));
    }
    return sum;
  }

  Vec3 prolong(Index i, const Vec3& value) const { return nearest(i, project(i, value)); }

  void prolong(const std::vector<Index>& parents, Index begin, Index end, const Vec3* coarser,
               Vec3* values) const {
    prolong_positions(*graph_, *frame_, parents, S, begin, end, coarser, values);
  }

  Vec3 merge(Index i, const Vec3& a, const Vec3& b, float share) const {
    const Vec3 pa = project(i, a);
    const PoSy<S> lattice(project(i, b), frame_->directions[i], graph_->normals[i],
                          frame_->edge_length[i]);
    return nearest(i, project(i, share * pa + (1 - share) * lattice.point(lattice.round(pa))));
  }

  /// The integers of an edge; for the intrinsic energy, those of the unfolded neighbour (t_ij of
  /// Eq. 5) as `j`.
  Translations match(Index i, std::size_t entry, const Vec3* field) const {
    const Index j = graph_->neighbors[entry];
    const PoSy<S> lattice = lattice_at(i, field);
    if constexpr (E == PositionEnergy::extrinsic) {
      const Vec3 q = intermediate_position(graph_->positions[i], graph_->normals[i],
                                           graph_->positions[j], graph_->normals[j]);
      return match_lattices(lattice, lattice_at(j, field), q);
    } else {
      PoSy<S> moved = lattice;
      moved.p = unfolded(i, j, field);
      return {{0, 0}, moved.round(field[i])};
    }
  }

  /// With integers held, the exact minimiser within the tangent plane: the mean of the neighbours'
  /// points less our own translation, by the integers of both directions of each edge, which need
  /// not ask for the same where the lattices of its ends differ.
  Vec3 relax_frozen(Index i, const Vec3* field, const Translations* integers) const {
    Vec3 sum = Vec3::Zero();
    float total = 0;
    const auto add = [&](const Vec3& offset, float weight, float rho) {
      sum += weight / (rho * rho) * offset;
      total += weight / (rho * rho);
    };
    for (Index e = graph_->offsets[i]; e < graph_->offsets[i + 1]; ++e) {
      const Index j = graph_->neighbors[e];
      const auto [own, other] = matched_pair(i, e, field, integers[e]);
      add(other - own, graph_->weight(e), frame_->edge_length[i]);
      const std::size_t back = graph_->entry(j, i);
      const auto [theirs, ours] = matched_pair(j, back, field, integers[back]);
      Vec3 offset = theirs - ours;
      if constexpr (E == PositionEnergy::intrinsic) {
        offset = transport(offset, graph_->normals[j], graph_->normals[i]);
      }
      add(offset, graph_->weight(back), frame_->edge_length[j]);
    }
    return total > 0 ? constrain(i, project(i, field[i] + sum / total)) : field[i];
  }

  double energy_frozen(Index i, const Vec3* field, const Translations* integers) const {
    double sum = 0;
    for (Index e = graph_->offsets[i]; e < graph_->offsets[i + 1]; ++e) {
      sum += graph_->weight(e) * squared_distance(i, e, field, integers[e]);
    }
    return sum;
  }

 private:
  PoSy<S> lattice_at(Index i, const Vec3* field) const {
    return {field[i], frame_->directions[i], graph_->normals[i], frame_->edge_length[i]};
  }

  /// The lattice point nearest to the node (last line of Eq. 7).
  Vec3 nearest(Index i, const Vec3& p) const {
    const PoSy<S> lattice(p, frame_->directions[i], graph_->normals[i], frame_->edge_length[i]);
    return lattice.point(lattice.round(graph_->positions[i]));
  }

  Vec3 project(Index i, const Vec3& p) const {
    return p - graph_->normals[i] * graph_->normals[i].dot(p - graph_->positions[i]);
  }

  /// p_ji: the neighbour's point unfolded into the tangent plane of i. Projected, as q_ij lies in
  /// both planes only as far as its epsilon lets it: parallel planes have no common point.
  Vec3 unfolded(Index i, Index j, const Vec3* field) const {
    const Vec3 &ni = graph_->normals[i], &nj = graph_->normals[j];
    const Vec3 q = intermediate_position(graph_->positions[i], ni, graph_->positions[j], nj);
    return project(i, q + transport(field[j] - q, nj, ni));
  }

  std::pair<Vec3, Vec3> matched_pair(Index i, std::size_t entry, const Vec3* field,
                                     const Translations& t) const {
    const Index j = graph_->neighbors[entry];
    PoSy<S> lattice = lattice_at(i, field);
    if constexpr (E == PositionEnergy::extrinsic) {
      return {lattice.point(t.i), lattice_at(j, field).point(t.j)};
    } else {
      lattice.p = unfolded(i, j, field);
      return {field[i], lattice.point(t.j)};
    }
  }

  double squared_distance(Index i, std::size_t entry, const Vec3* field,
                          const Translations& t) const {
    const auto [own, other] = matched_pair(i, entry, field, t);
    const float rho = frame_->edge_length[i];
    return (own - other).squaredNorm() / (rho * rho);
  }

  /// Section 3.7: between the value found and its projection onto the plane spanned by the normal
  /// and the constraint's line (or, without a direction, the constraint's point).
  Vec3 constrain(Index i, const Vec3& p) const {
    if (constraints_->strengths.empty() || constraints_->strengths[i] == 0) return p;
    const Vec3 &c = constraints_->points[i], &d = constraints_->directions[i];
    const PoSy<S> lattice(p, frame_->directions[i], graph_->normals[i], frame_->edge_length[i]);
    // Of the lattice, the point nearest to the line is the one to pull: any of its row would do.
    const Vec3 x = graph_->positions[i];
    const Vec3 foot = d.isZero() ? c : Vec3(c + d * d.dot(x - c));
    const Vec3 own = lattice.point(lattice.round(foot));
    // A line that does not lie in the tangent plane must not pull along itself, only sideways.
    const Vec3 across = graph_->normals[i].cross(d);
    const float square = across.squaredNorm();
    const Vec3 offset =
        square > 1e-6f ? Vec3(across * (across.dot(c - own) / square)) : Vec3(c - own);
    return project(i, own + constraints_->strengths[i] * offset);
  }

  const Graph* graph_;
  const LatticeFrame* frame_;
  const LineConstraints* constraints_;
  float extent_;
};

}  // namespace meshgrain
