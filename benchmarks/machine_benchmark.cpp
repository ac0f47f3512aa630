// What the machine can do at best: the other benchmarks are measured against it.

#include <algorithm>
#include <vector>

#include "inputs.h"
#include "meshgrain/context.h"
#include "multiply_add.h"

namespace meshgrain::bench {
namespace {

/// Twice the largest cache, so that three arrays of it leave nothing there from round to round.
std::size_t triad_count() {
  std::size_t largest = std::size_t{32} << 20;
  for (const auto& cache : benchmark::CPUInfo::Get().caches) {
    largest = std::max(largest, static_cast<std::size_t>(cache.size));
  }
  return 2 * largest / sizeof(float);
}

/// McCalpin's triad (STREAM): two arrays are read and one is written.
void triad(benchmark::State& state) {
  const Context context(threads(state));
  const std::size_t all = triad_count();
  std::vector<float> a(all, 0.0f);
  const std::vector<float> b(all, 1.0f), c(all, 2.0f);
  for (auto _ : state) {
    context.for_ranges(all, std::size_t{1} << 18, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) a[k] = b[k] + 3.0f * c[k];
    });
    benchmark::ClobberMemory();
  }
  state.counters["bytes/s"] = benchmark::Counter(static_cast<double>(3 * all * sizeof(float)),
                                                 benchmark::Counter::kIsIterationInvariantRate,
                                                 benchmark::Counter::kIs1024);
}

void multiply_adds(benchmark::State& state) {
  const Context context(threads(state));
  constexpr std::size_t parts = 64, rounds = 100000;
  std::vector<std::size_t> done(parts);
  std::vector<float> results(parts);
  for (auto _ : state) {
    context.for_ranges(parts, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) done[k] = multiply_add(rounds, results[k]);
    });
    benchmark::DoNotOptimize(results.data());
  }
  state.counters["multiply-adds/s"] = benchmark::Counter(
      static_cast<double>(parts * done[0]), benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(triad)->Apply(with_threads);
BENCHMARK(multiply_adds)->Name("multiply-add")->Apply(with_threads);

}  // namespace
}  // namespace meshgrain::bench
