#include "field/jumps.h"

#include "field/posy.h"
#include "field/with_symmetry.h"

namespace meshgrain {
namespace {

template <int S>
Jump jump_between(const Graph& graph, const OrientationField& orientation,
                  const PositionField& position, PositionEnergy energy, Index i, Index j) {
  const Vec3 &ni = graph.normals[i], &nj = graph.normals[j];
  const Vec3 &oi = orientation.directions[i], &oj = orientation.directions[j];
  const PoSy<S> lattice(position.points[i], oi, ni, position.edge_length[i]);
  const Vec3 q = intermediate_position(graph.positions[i], ni, graph.positions[j], nj);
  Jump jump;
  if (energy == PositionEnergy::extrinsic) {
    const Rotations k = RoSy<S>::match_extrinsic(oi, ni, oj, nj);
    jump.rotation = RoSy<S>::compose(k.j, RoSy<S>::inverse(k.i));
    const PoSy<S> neighbor(position.points[j], RoSy<S>::rotate(oj, nj, jump.rotation), nj,
                           position.edge_length[j]);
    const Translations t = match_lattices(lattice, neighbor, q);
    jump.t = {t.i[0] - t.j[0], t.i[1] - t.j[1]};
  } else {
    jump.rotation = RoSy<S>::match_intrinsic(oi, ni, transport(oj, nj, ni));
    jump.t = lattice.round(q + transport(position.points[j] - q, nj, ni));
  }
  return jump;
}

}  // namespace

Jump edge_jump(const Graph& graph, const OrientationField& orientation,
               const PositionField& position, PositionEnergy energy, Index i, Index j) {
  return with_posy(position.posy, [&]<int S>() {
    return jump_between<S>(graph, orientation, position, energy, i, j);
  });
}

std::vector<Jump> edge_jumps(const Graph& graph, const OrientationField& orientation,
                             const PositionField& position, PositionEnergy energy,
                             const Context& context) {
  std::vector<Jump> jumps(graph.neighbors.size());
  with_posy(position.posy, [&]<int S>() {
    context.for_ranges(graph.size(), 2048, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
          jumps[e] = jump_between<S>(graph, orientation, position, energy, static_cast<Index>(i),
                                     graph.neighbors[e]);
        }
      }
    });
  });
  return jumps;
}

}  // namespace meshgrain
