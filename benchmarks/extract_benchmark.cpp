#include "inputs.h"

namespace meshgrain::bench {
namespace {

void extract(benchmark::State& state) {
  const Context context(threads(state));
  ExtractOptions options;
  options.surface = &surface();
  const OrientationField& directions = orientation();
  const PositionField& points = position();
  for (auto _ : state) {
    benchmark::DoNotOptimize(extract_mesh(graph(), directions, points, options, context));
  }
  const std::size_t fields = 2 * graph().size() * sizeof(Vec3);
  count(state, bytes(graph()) + bytes(surface()) + fields + bytes(extraction().mesh));
}

BENCHMARK(extract)->Name("extraction")->Apply(with_threads);

}  // namespace
}  // namespace meshgrain::bench
