#include "inputs.h"
#include "meshgrain/clean.h"
#include "meshgrain/surface.h"

namespace meshgrain::bench {
namespace {

/// `work` changes a mesh; each time it gets a fresh copy of `input`, which is not timed.
template <typename Work>
void change(benchmark::State& state, const Mesh& input, const Work& work) {
  const Context context(threads(state));
  for (auto _ : state) {
    state.PauseTiming();
    Mesh mesh = input;
    state.ResumeTiming();
    work(mesh, context);
    benchmark::DoNotOptimize(mesh);
  }
  count(state, 2 * bytes(input));
}

void clean_up(benchmark::State& state) {
  change(state, shape(), [](Mesh& mesh, const Context& context) { clean(mesh, context); });
}

void order(benchmark::State& state) {
  change(state, shape(),
         [](Mesh& mesh, const Context& context) { sort_along_curve(mesh, context); });
}

void coarsen_to_a_third(benchmark::State& state) {
  Mesh input = shape();
  sort_along_curve(input);
  const auto mean = static_cast<float>(edge_lengths(input).mean);
  change(state, input, [&](Mesh& mesh, const Context& context) {
    coarsen(mesh, {1.2f * mean, 2.7f * mean}, std::vector<std::uint8_t>(mesh.positions.size(), 0),
            context);
  });
}

BENCHMARK(clean_up)->Name("clean")->Apply(with_threads);
BENCHMARK(order)->Apply(with_threads);
BENCHMARK(coarsen_to_a_third)->Name("coarsen")->Apply(with_threads);

}  // namespace
}  // namespace meshgrain::bench
