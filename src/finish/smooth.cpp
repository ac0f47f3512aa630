#include "finish/smooth.h"

#include <Eigen/Geometry>
#include <map>
#include <ranges>
#include <utility>

#include "finish/bare_ends.h"
#include "finish/fit_to_surface.h"
#include "finish/local_search.h"
#include "finish/mean_side.h"
#include "finish/mend_places.h"
#include "finish/own_side.h"
#include "finish/placement.h"
#include "finish/regular_polygon.h"
#include "finish/small_holes.h"
#include "finish/unfold.h"
#include "finish/untangle.h"
#include "measure/face_shape.h"
#include "meshgrain/surface.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 256;

/// Faces in batches in which all have as many corners.
template <typename Which>
std::vector<std::vector<Index>> batches_of(const Faces& faces, const Which& which) {
  constexpr std::size_t most = 512;
  std::vector<std::vector<Index>> batches;
  std::map<std::size_t, std::vector<Index>> open;  // by the number of corners
  for (const Index f : which) {
    std::vector<Index>& batch = open[faces.degree(f)];
    batch.push_back(f);
    if (batch.size() == most) batches.push_back(std::exchange(batch, {}));
  }
  for (auto& [degree, batch] : open) {
    if (!batch.empty()) batches.push_back(std::move(batch));
  }
  return batches;
}

/// Each iteration fits a regular polygon to every face, moves each vertex to the mean of its places
/// in those, and back onto the surface.
class Smoother {
 public:
  enum class Start { on_surface, as_it_is };

  /// May put all vertices onto the surface.
  Smoother(Extraction& extraction, const Mesh& surface, const VertexFaces& around_surface,
           const Graph& graph, const FeatureLines& features, const SmoothOptions& options,
           Start start, const Context& context);

  /// How many there are to be.
  int iterations() const;

  /// `put_on`: exactly onto the surface, at the end.
  void iterate(int iterations, bool put_on);

  /// See the function.
  void open_small_holes(const FeatureLines& lines) {
    meshgrain::open_small_holes(extraction_, around_, lines, mean_side(mesh_, sizes_, context_),
                                placement_);
  }

  /// Pulls the mesh out to the ends of fingers and horns, and holds it there.
  void hold_ends();

  /// Mends single faces that are turned over, nearly degenerate, or pass through others.
  void mend();

  /// Brings the faces nearer to the surface, with vertices that go off it.
  void fit_faces();

  /// Brings faces off other sides of the surface, where it is thin.
  void keep_to_own_side();

 private:
  template <typename Body>
  void for_vertices(const Body& body) const;
  /// Runs move(v), which writes places[v], for all vertices; where it says so, a plane that touches
  /// the surface there is then looked for, and the place put on it.
  template <typename Move>
  void move_vertices(const Move& move, std::vector<Vec3>& places);
  void look_up_sizes();
  /// Returns the faces that are folded.
  std::vector<Index> fit_polygons(const std::vector<std::vector<Index>>& batches, float side);
  void unfold(const std::vector<Index>& folded, float side);
  Vec3 mean_target(Index v) const;

  /// How far vertices go, in ways to the mean of their targets, and which share of their last step
  /// they take again.
  struct Step {
    float length, momentum;
  };
  Step step() const;

  Extraction& extraction_;
  Mesh& mesh_;
  const Graph& graph_;
  bool nodes_are_vertices_;
  const SmoothOptions& options_;
  const Context& context_;
  Placement placement_;
  VertexFaces around_;
  std::vector<Index> corners_;  // beside around_.faces: which corner of the face the vertex is
  std::vector<std::vector<Index>> batches_;  // all faces
  EdgeLength sizes_{1.0f};                   // relative, of the vertices where they are
  std::vector<Vec3> previous_;               // positions, one iteration ago
  int done_ = 0;                             // iterations
  bool short_steps_;  // a mesh of few faces, large beside what they cover, could swing through
                      // itself
  std::vector<Vec3> targets_;  // of every corner of a face
  std::vector<Vec3> normals_;  // of the surface

  /// Where a vertex was when it looked for the plane that touches the surface near it.
  struct Touch {
    Vec3 from = Vec3::Zero();
    Projector::Plane plane;  // at first none: it leaves all as it is

    /// Whether the plane is good enough for a vertex that has come to p.
    bool serves(const Vec3& p, float side) const {
      constexpr float far = 0.1f;
      return !plane.normal.isZero(0) && (p - from).squaredNorm() < far * far * side * side;
    }
  };
  std::vector<Touch> touches_;
};

Smoother::Smoother(Extraction& extraction, const Mesh& surface, const VertexFaces& around_surface,
                   const Graph& graph, const FeatureLines& features, const SmoothOptions& options,
                   Start start, const Context& context)
    : extraction_(extraction),
      mesh_(extraction.mesh),
      graph_(graph),
      nodes_are_vertices_(graph.size() == surface.positions.size()),
      options_(options),
      context_(context),
      placement_(extraction, surface, around_surface, graph, features, context),
      around_(vertex_faces(mesh_, context)),
      corners_(around_.faces.size()),
      batches_(batches_of(mesh_.faces,
                          std::views::iota(Index{0}, static_cast<Index>(mesh_.faces.size())))),
      short_steps_(mesh_.faces.size() < few_faces),
      targets_(mesh_.faces.corners().size()) {
  for_vertices([&](std::size_t v) {
    for (Index k = around_.offsets[v]; k < around_.offsets[v + 1]; ++k) {
      const auto face = std::as_const(mesh_.faces)[around_.faces[k]];
      corners_[k] = static_cast<Index>(mesh_.faces.first(around_.faces[k]) +
                                       corner_of(face, static_cast<Index>(v)));
    }
  });
  normals_.resize(mesh_.positions.size());
  touches_.resize(mesh_.positions.size());
  // The corners of a part are its rim as well, which has to fit what is around it.
  if (!options.is_part) {
    for (const Index v : extraction.corners) {
      mesh_.positions[v] = surface.positions[extraction.nodes[v]];
    }
  }
  previous_ = mesh_.positions;
  if (start == Start::as_it_is) {
    placement_.go_around(around_);
    for_vertices([&](std::size_t v) { normals_[v] = placement_.normal(v); });
    return;
  }
  move_vertices(
      [&](Index v) {
        if (options.iterations > 0 && placement_.is_free(v)) return true;
        previous_[v] = placement_.place(mesh_.positions[v], v);
        normals_[v] = placement_.normal(v);
        return false;
      },
      previous_);
  mesh_.positions = previous_;
  placement_.go_around(around_);
  previous_ = mesh_.positions;
}

template <typename Body>
void Smoother::for_vertices(const Body& body) const {
  context_.for_ranges(mesh_.positions.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) body(v);
  });
}

template <typename Move>
void Smoother::move_vertices(const Move& move, std::vector<Vec3>& places) {
  context_.for_ranges(places.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::vector<Index> looking;
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      if (move(v)) looking.push_back(v);
    }
    for (std::size_t k = 0; k < looking.size(); ++k) {
      placement_.prefetch(looking, k);
      const Index v = looking[k];
      touches_[v] = {places[v], placement_.touch(places[v], v)};
      normals_[v] = touches_[v].plane.normal;
      places[v] = touches_[v].plane.project(places[v]);
    }
  });
}

void Smoother::look_up_sizes() {
  if (options_.relative_size.uniform()) return;
  sizes_.values.resize(mesh_.positions.size());
  for_vertices(
      [&](std::size_t v) { sizes_.values[v] = options_.relative_size[extraction_.nodes[v]]; });
}

std::vector<Index> Smoother::fit_polygons(const std::vector<std::vector<Index>>& batches,
                                          float side) {
  const PolygonFit fit{side, static_cast<float>(options_.evenness), sizes_};
  std::vector<std::vector<Index>> folded(batches.size());
  context_.for_ranges(batches.size(), 1, [&](std::size_t k, std::size_t) {
    fit_regular_polygons(mesh_, batches[k], normals_, fit, targets_, folded[k]);
  });
  std::vector<Index> all;
  for (const auto& some : folded) all.insert(all.end(), some.begin(), some.end());
  return all;
}

void Smoother::unfold(const std::vector<Index>& folded, float side) {
  std::vector<Index> changed;  // faces
  for (const Index v : meshgrain::unfold(extraction_, around_, placement_, normals_, folded)) {
    previous_[v] = mesh_.positions[v];
    touches_[v] = {};
    changed.insert(changed.end(), around_[v].begin(), around_[v].end());
  }
  sort_unique(changed);
  fit_polygons(batches_of(mesh_.faces, changed), side);
}

Vec3 Smoother::mean_target(Index v) const {
  Vec3 sum = Vec3::Zero();
  for (Index k = around_.offsets[v]; k < around_.offsets[v + 1]; ++k) sum += targets_[corners_[k]];
  return sum / static_cast<float>(around_[v].size());
}

int Smoother::iterations() const {
  constexpr double more = 2.25;  // which need short steps to come as far
  return short_steps_ ? static_cast<int>(more * options_.iterations) : options_.iterations;
}

Smoother::Step Smoother::step() const {
  // Each step goes on in part where the last one went (Polyak's heavy ball): faults that reach far
  // then fade in as many iterations as they are edges wide, rather than in the square of that.
  // Fitted polygons never overshoot, so that steps may be up to 2 (1 + momentum) times as long.
  constexpr Step short_step{1, 0.9f}, long_step{3, 0.84f}, settling{1, 0.4f};
  constexpr int last = 4;
  if (!short_steps_ && done_ >= options_.iterations - last) return settling;
  Step step = short_steps_ ? short_step : long_step;
  if (done_ < options_.slow_start) {
    step.momentum *= static_cast<float>(done_) / static_cast<float>(options_.slow_start);
  }
  return step;
}

void Smoother::iterate(int iterations, bool put_on) {
  constexpr int between_looks = 4;  // at sizes, and at lines
  std::vector<Vec3> next(mesh_.positions.size());
  float side = 0;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    context_.check();
    // Parts of a mesh are smoothed on many threads at once, and that is not theirs to say.
    if (!options_.is_part) {
      context_.progress("smoothing", static_cast<double>(done_) / this->iterations());
    }
    const auto [length, momentum] = step();
    ++done_;
    const bool look = iteration % between_looks == 0;
    const bool may_look = iteration % 2 == 0;  // at the surface
    const bool exactly = put_on && iteration + 1 == iterations;
    if (look) {
      look_up_sizes();
      side = mean_side(mesh_, sizes_, context_);
    }
    const std::vector<Index> folded = fit_polygons(batches_, side);
    if (may_look && iteration > 0) unfold(folded, side);
    placement_.note_ways(context_);
    move_vertices(
        [&](Index v) {
          const Vec3& p = mesh_.positions[v];
          next[v] = p + momentum * (p - previous_[v]);
          if (!around_[v].empty()) next[v] += length * (mean_target(v) - p);
          if (exactly || !placement_.is_free(v)) {
            next[v] = placement_.slide(next[v], v);
            if (look) normals_[v] = placement_.normal(v);
            return false;
          }
          // From inside of a thin finger, the nearest point may be on its other side.
          next[v] = touches_[v].plane.project(next[v]);
          return may_look && !touches_[v].serves(next[v], side);
        },
        next);
    previous_.swap(mesh_.positions);
    mesh_.positions.swap(next);
  }
}

void Smoother::hold_ends() {
  if (!nodes_are_vertices_ || options_.is_part) return;
  constexpr float share = 0.9f;
  const float side = mean_side(mesh_, sizes_, context_);
  EdgeLength reach = options_.relative_size;
  for (float& length : reach.values) length *= share * side;
  for (const Reach& end : find_bare_ends(extraction_, around_, graph_, reach, context_)) {
    if (!placement_.is_free(end.vertex) && !placement_.is_tethered(end.vertex)) continue;
    placement_.tether(end.vertex, end.position, end.node, end.tip, end.radius);
    previous_[end.vertex] = end.position;
  }
}

void Smoother::mend() {
  placement_.fit_lines();
  LocalSearch search(extraction_, around_, placement_, context_);
  constexpr int sweeps = 30, sweeps_of_part = 8;
  untangle(mesh_, around_, search, options_.is_part ? sweeps_of_part : sweeps, context_);
  if (options_.mends_places) mend_places(mesh_, around_, placement_, search, options_, context_);
}

void Smoother::fit_faces() {
  if (options_.fit > 0) fit_to_surface(extraction_, around_, placement_, options_.fit, context_);
}

void Smoother::keep_to_own_side() {
  look_up_sizes();
  const PolygonFit fit{mean_side(mesh_, sizes_, context_), 1, sizes_};
  meshgrain::keep_to_own_side(mesh_, around_, placement_, normals_, fit, context_);
}

/// The lines to follow if there are none given.
FeatureLines border_if_needed(const Mesh& surface, const SmoothOptions& options,
                              const Context& context) {
  if (options.features != nullptr || surface.is_point_cloud()) return {};
  return find_features(surface, {.creases = Creases::none, .align_border = false}, 0, context);
}

/// One step of smooth(), from where the vertices are.
void do_alone(void (Smoother::*step)(), Extraction& extraction, const Mesh& surface,
              const VertexFaces& around_surface, const Graph& graph, const SmoothOptions& options,
              const Context& context) {
  const FeatureLines border = border_if_needed(surface, options, context);
  const FeatureLines& features = options.features != nullptr ? *options.features : border;
  Smoother smoother(extraction, surface, around_surface, graph, features, options,
                    Smoother::Start::as_it_is, context);
  (smoother.*step)();
}

}  // namespace

void smooth(Extraction& extraction, const Mesh& surface, const Graph& graph,
            const SmoothOptions& options, const Context& context) {
  const bool is_cloud = surface.is_point_cloud();
  smooth(extraction, surface, is_cloud ? VertexFaces{} : vertex_faces(surface, context), graph,
         options, context);
}

bool smooth(Extraction& extraction, const Mesh& surface, const VertexFaces& around_surface,
            const Graph& graph, const SmoothOptions& options, const Context& context,
            const std::function<bool()>& is_worth_it) {
  const FeatureLines border = border_if_needed(surface, options, context);
  const FeatureLines& features = options.features != nullptr ? *options.features : border;
  Smoother smoother(extraction, surface, around_surface, graph, features, options,
                    Smoother::Start::on_surface, context);
  if (options.iterations == 0) return true;
  smoother.open_small_holes(features);
  // Even sizes draw the surface's ends in first of all, so that they show early.
  constexpr int hold_after[] = {1, 2, 4}, whole = 6;  // sixths of the iterations
  const int iterations = smoother.iterations();
  int done = 0;
  for (const int sixths : hold_after) {
    const int until = iterations * sixths / whole;
    smoother.iterate(until - done, false);
    smoother.hold_ends();
    done = until;
  }
  smoother.iterate(iterations - done, true);
  if (is_worth_it && !is_worth_it()) return false;
  smoother.mend();
  smoother.fit_faces();
  if (!options.is_part) smoother.keep_to_own_side();
  return true;
}

void keep_to_own_side(Extraction& extraction, const Mesh& surface,
                      const VertexFaces& around_surface, const Graph& graph,
                      const SmoothOptions& options, const Context& context) {
  do_alone(&Smoother::keep_to_own_side, extraction, surface, around_surface, graph, options,
           context);
}

void mend(Extraction& extraction, const Mesh& surface, const VertexFaces& around_surface,
          const Graph& graph, const SmoothOptions& options, const Context& context) {
  do_alone(&Smoother::mend, extraction, surface, around_surface, graph, options, context);
}

}  // namespace meshgrain
