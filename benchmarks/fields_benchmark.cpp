// Both fields, all sweeps from the coarsest level to the finest.

#include "inputs.h"
#include "meshgrain/fields.h"

namespace meshgrain::bench {
namespace {

std::size_t bytes_of_field() {
  return graph().size() * sizeof(Vec3);
}

void orientation_field(benchmark::State& state) {
  const Context context(threads(state));
  const Hierarchy& levels = hierarchy();
  for (auto _ : state) benchmark::DoNotOptimize(solve_orientation(levels, {}, {}, context));
  count(state, bytes(hierarchy()) + bytes_of_field());
}

void position_field(benchmark::State& state) {
  const Context context(threads(state));
  const Hierarchy& levels = hierarchy();
  const OrientationField& directions = orientation();
  const EdgeLength length = edge_length();
  for (auto _ : state) {
    benchmark::DoNotOptimize(solve_position(levels, directions, length, {}, {}, context));
  }
  count(state, bytes(hierarchy()) + 2 * bytes_of_field());
}

BENCHMARK(orientation_field)->Name("orientation field")->Apply(with_threads);
BENCHMARK(position_field)->Name("position field")->Apply(with_threads);

}  // namespace
}  // namespace meshgrain::bench
