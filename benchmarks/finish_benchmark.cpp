#include "inputs.h"
#include "meshgrain/finish.h"

namespace meshgrain::bench {
namespace {

void smooth_faces(benchmark::State& state) {
  const Context context(threads(state));
  for (auto _ : state) {
    state.PauseTiming();
    Extraction faces = extraction();
    state.ResumeTiming();
    smooth(faces, surface(), graph(), {}, context);
    benchmark::DoNotOptimize(faces);
  }
  count(state, bytes(graph()) + bytes(surface()) + 2 * bytes(extraction().mesh));
}

BENCHMARK(smooth_faces)->Name("smoothing")->Apply(with_threads);

}  // namespace
}  // namespace meshgrain::bench
