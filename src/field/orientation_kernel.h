#pragma once

#include <complex>

#include "field/carry_fields.h"
#include "field/relax_orientations.h"
#include "field/rosy.h"
#include "util/hash.h"

namespace meshgrain {

/// One node's part of an orientation field (section 3.2): the energies of Eq. 2 and 4, and that of
/// Knöppel et al., for every N-RoSy. The value is the representative vector; its length is 1 but
/// for the convex energy, which leaves it free.
template <int N, OrientationEnergy E>
class OrientationKernel {
 public:
  using Value = Vec3;
  using Integers = Rotations;
  using Group = RoSy<N>;

  OrientationKernel(const Graph& graph, const DirectionConstraints& constraints)
      : graph_(&graph), constraints_(&constraints) {}

  Vec3 random(Index i, std::uint64_t hash) const {
    const float angle = 6.28318531f * unit_float(hash64(hash));
    const Vec3& n = graph_->normals[i];
    const Vec3 u = any_tangent(n);
    return std::cos(angle) * u + std::sin(angle) * n.cross(u);
  }

  /// Eq. 3, for nodes that are no neighbours of each other.
  void relax(std::span<const Index> nodes, const Vec3* field, Vec3* values) const {
    if constexpr (E == OrientationEnergy::convex) {
      for (const Index i : nodes) *values++ = constrain(i, convex_mean(i, field));
    } else {
      relax_orientations(*graph_, *constraints_, N, E, nodes, field, values);
    }
  }

  double energy(Index i, const Vec3* field) const {
    double sum = 0;
    for (Index e = graph_->offsets[i]; e < graph_->offsets[i + 1]; ++e) {
      const auto [a, b] = matched_pair(i, e, field, match(i, e, field));
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      sum += graph_->weight(e) * angle * angle;
    }
    return sum;
  }

  Vec3 prolong(Index i, const Vec3& value) const {
    const Vec3 v = project_to_plane(value, graph_->normals[i]);
    const float length = v.norm();
    if (!(length > 1e-6f * value.norm()) || length == 0) return any_tangent(graph_->normals[i]);
    if constexpr (E == OrientationEnergy::convex) return v * (value.norm() / length);
    return v / length;
  }

  void prolong(const std::vector<Index>& parents, Index begin, Index end, const Vec3* coarser,
               Vec3* values) const {
    if constexpr (E == OrientationEnergy::convex) {
      for (Index i = begin; i < end; ++i) values[i] = prolong(i, coarser[parents[i]]);
    } else {
      prolong_orientations(*graph_, parents, begin, end, coarser, values);
    }
  }

  Vec3 merge(Index i, const Vec3& a, const Vec3& b, float share) const {
    const Vec3& n = graph_->normals[i];
    const Vec3 pa = prolong(i, a), pb = prolong(i, b);
    const Vec3 sum =
        share * pa + (1 - share) * Group::rotate(pb, n, Group::match_intrinsic(pa, n, pb));
    return prolong(i, sum);
  }

  Rotations match(Index i, std::size_t entry, const Vec3* field) const {
    const Index j = graph_->neighbors[entry];
    const Vec3 &ni = graph_->normals[i], &nj = graph_->normals[j];
    if constexpr (E == OrientationEnergy::extrinsic) {
      return Group::match_extrinsic(field[i], ni, field[j], nj);
    } else {
      return {0, Group::match_intrinsic(field[i], ni, transport(field[j], nj, ni))};
    }
  }

  /// With integers held, the mean of the neighbours, each turned back by k_ij: the exact minimiser
  /// of the energy of chords, which agrees with that of angles up to fourth order. The convex
  /// energy's minimiser is the mean itself, of any length.
  Vec3 relax_frozen(Index i, const Vec3* field, const Rotations* integers) const {
    const Vec3& n = graph_->normals[i];
    Vec3 sum = Vec3::Zero();
    float total = 0;
    for (Index e = graph_->offsets[i]; e < graph_->offsets[i + 1]; ++e) {
      const auto [a, b] = matched_pair(i, e, field, integers[e]);
      const Vec3 back = Group::rotate(project_to_plane(b, n), n, Group::inverse(integers[e].i));
      sum += graph_->weight(e) * back;
      total += graph_->weight(e);
    }
    if constexpr (E == OrientationEnergy::convex) {
      return total > 0 ? constrain(i, sum / total) : field[i];
    }
    return constrain(i, normalized_or(sum, field[i]));
  }

  double energy_frozen(Index i, const Vec3* field, const Rotations* integers) const {
    double sum = 0;
    for (Index e = graph_->offsets[i]; e < graph_->offsets[i + 1]; ++e) {
      const auto [a, b] = matched_pair(i, e, field, integers[e]);
      sum += graph_->weight(e) * (a - b).squaredNorm();
    }
    return sum;
  }

 private:
  static Vec3 normalized_or(const Vec3& v, const Vec3& fallback) {
    const float length = v.norm();
    return length > 1e-6f ? Vec3(v / length) : fallback;
  }

  /// Both representatives of an edge, turned by its integers (and unfolded, if that is the energy).
  std::pair<Vec3, Vec3> matched_pair(Index i, std::size_t entry, const Vec3* field,
                                     const Rotations& k) const {
    const Index j = graph_->neighbors[entry];
    const Vec3 &ni = graph_->normals[i], &nj = graph_->normals[j];
    if constexpr (E == OrientationEnergy::extrinsic) {
      return {Group::rotate(field[i], ni, k.i), Group::rotate(field[j], nj, k.j)};
    } else {
      return {field[i], Group::rotate(transport(field[j], nj, ni), ni, k.j)};
    }
  }

  /// The mean of the neighbours after the change of variables z -> z^N, which makes all
  /// representatives equal, and back. The length is kept: it is small near singularities, where the
  /// neighbours disagree.
  Vec3 convex_mean(Index i, const Vec3* field) const {
    using Complex = std::complex<float>;
    const Vec3& n = graph_->normals[i];
    const Vec3 u = any_tangent(n), v = n.cross(u);
    Complex sum = 0;
    float total = 0;
    for (Index e = graph_->offsets[i]; e < graph_->offsets[i + 1]; ++e) {
      const Index j = graph_->neighbors[e];
      const Vec3 oji = transport(field[j], graph_->normals[j], n);
      const float length = oji.norm();
      if (length == 0) continue;
      const Complex z(oji.dot(u) / length, oji.dot(v) / length);
      Complex power = z;
      for (int k = 1; k < N; ++k) power *= z;
      sum += graph_->weight(e) * length * power;
      total += graph_->weight(e);
    }
    const float length = std::abs(sum);
    if (length == 0 || total == 0) return field[i];
    const float angle = std::arg(sum) / N;
    return (length / total) * (std::cos(angle) * u + std::sin(angle) * v);
  }

  /// Section 3.7: between the value found and the constraint, in its most similar rotation.
  Vec3 constrain(Index i, const Vec3& value) const {
    if (constraints_->strengths.empty() || constraints_->strengths[i] == 0) return value;
    const Vec3& n = graph_->normals[i];
    const float length = value.norm(), strength = constraints_->strengths[i];
    const Vec3& direction = constraints_->directions[i];
    if (!(project_to_plane(direction, n).norm() > 1e-6f)) return value;  // along the normal
    const Vec3 target = prolong(i, direction).normalized();
    const Vec3 similar = Group::rotate(target, n, Group::match_intrinsic(value, n, target));
    const Vec3 mixed = (1 - strength) * value + (strength * length) * similar;
    if constexpr (E == OrientationEnergy::convex) return mixed;
    return normalized_or(project_to_plane(mixed, n), similar);
  }

  const Graph* graph_;
  const DirectionConstraints* constraints_;
};

}  // namespace meshgrain
