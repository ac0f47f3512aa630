#include "inputs.h"
#include "meshgrain/graph.h"

namespace meshgrain::bench {
namespace {

void make_graph(benchmark::State& state) {
  const Context context(threads(state));
  const Mesh& mesh = surface();
  for (auto _ : state) benchmark::DoNotOptimize(build_graph(mesh, {}, context));
  count(state, bytes(surface()) + bytes(graph()));
}

void make_hierarchy(benchmark::State& state) {
  const Context context(threads(state));
  for (auto _ : state) {
    state.PauseTiming();
    Graph finest = graph();
    state.ResumeTiming();
    benchmark::DoNotOptimize(build_hierarchy(std::move(finest), context));
  }
  // The finest level is handed on as it came in.
  count(state, bytes(hierarchy()));
}

BENCHMARK(make_graph)->Name("graph")->Apply(with_threads);
BENCHMARK(make_hierarchy)->Name("hierarchy")->Apply(with_threads);

}  // namespace
}  // namespace meshgrain::bench
