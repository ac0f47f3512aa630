#include "inputs.h"

#include <cmath>

#include "meshgrain/clean.h"
#include "meshgrain/graph.h"
#include "meshgrain/shapes.h"
#include "meshgrain/surface.h"

namespace meshgrain::bench {
namespace {

template <typename T>
std::size_t bytes_of(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

Mesh sorted_shape() {
  Mesh mesh = shape();
  clean(mesh);
  sort_along_curve(mesh);
  return mesh;
}

}  // namespace

const Mesh& shape() {
  static const Mesh mesh = sample_shape("blob", 25.0 / 6);
  return mesh;
}

const Mesh& surface() {
  static const Mesh mesh = sorted_shape();
  return mesh;
}

const Hierarchy& hierarchy() {
  static const Hierarchy levels = build_hierarchy(build_graph(surface()));
  return levels;
}

const Graph& graph() {
  return hierarchy().levels[0];
}

const OrientationField& orientation() {
  static const OrientationField field = solve_orientation(hierarchy());
  return field;
}

EdgeLength edge_length() {
  const double faces = static_cast<double>(surface().positions.size()) / 16;
  return EdgeLength(static_cast<float>(std::sqrt(surface_area(surface()) / faces)));
}

const PositionField& position() {
  static const PositionField field = solve_position(hierarchy(), orientation(), edge_length());
  return field;
}

const Extraction& extraction() {
  ExtractOptions options;
  options.surface = &surface();
  static const Extraction result = extract_mesh(graph(), orientation(), position(), options);
  return result;
}

std::size_t bytes(const Mesh& mesh) {
  return bytes_of(mesh.positions) + mesh.faces.corners().size_bytes();
}

std::size_t bytes(const Graph& graph) {
  return bytes_of(graph.positions) + bytes_of(graph.normals) + bytes_of(graph.areas) +
         bytes_of(graph.offsets) + bytes_of(graph.neighbors) + bytes_of(graph.weights);
}

std::size_t bytes(const Hierarchy& hierarchy) {
  std::size_t sum = 0;
  for (const Graph& level : hierarchy.levels) sum += bytes(level);
  for (const auto& parents : hierarchy.parents) sum += bytes_of(parents);
  for (const Children& c : hierarchy.children) sum += bytes_of(c.offsets) + bytes_of(c.nodes);
  return sum;
}

void with_threads(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("threads")->Arg(1)->Arg(0)->UseRealTime()->Unit(benchmark::kMillisecond);
}

int threads(const benchmark::State& state) {
  return static_cast<int>(state.range(0));
}

void count(benchmark::State& state, std::size_t bytes) {
  using benchmark::Counter;
  const auto all = static_cast<double>(shape().positions.size());
  state.counters["vertices"] = all;
  state.counters["bytes"] = static_cast<double>(bytes);
  state.counters["vertices/s"] = Counter(all, Counter::kIsIterationInvariantRate);
  state.counters["bytes/s"] =
      Counter(static_cast<double>(bytes), Counter::kIsIterationInvariantRate, Counter::kIs1024);
}

}  // namespace meshgrain::bench
