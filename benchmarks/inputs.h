#pragma once

#include <benchmark/benchmark.h>

#include <cstddef>

#include "meshgrain/extract.h"
#include "meshgrain/fields.h"
#include "meshgrain/hierarchy.h"
#include "meshgrain/mesh.h"

/// What the stages get in a run of the program over one made shape of about 100,000 vertices. Each
/// value is made once, when it is first asked for: do so before what is timed.
namespace meshgrain::bench {

/// As a file has it.
const Mesh& shape();

/// In the order of a curve.
const Mesh& surface();

const Hierarchy& hierarchy();
const Graph& graph();
const OrientationField& orientation();

/// Edges for a sixteenth as many faces as there are vertices, as by default.
EdgeLength edge_length();

const PositionField& position();
const Extraction& extraction();

/// Bytes that a value holds.
std::size_t bytes(const Mesh& mesh);
std::size_t bytes(const Graph& graph);
std::size_t bytes(const Hierarchy& hierarchy);

/// Runs a benchmark with one thread and, as argument 0, with all cores. Times are of the clock.
void with_threads(benchmark::internal::Benchmark* benchmark);
int threads(const benchmark::State& state);

/// Counters of a stage over shape(): its vertices, the bytes of what it must read and write at
/// least once, and both a second.
void count(benchmark::State& state, std::size_t bytes);

}  // namespace meshgrain::bench
