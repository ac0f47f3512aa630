#include "finish/unfold.h"

#include <algorithm>
#include <span>
#include <utility>

#include "measure/face_shape.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

class Unfolding {
 public:
  Unfolding(Extraction& extraction, const VertexFaces& around, Placement& placement,
            std::vector<Vec3>& normals)
      : mesh_(extraction.mesh), around_(around), placement_(placement), normals_(normals) {}

  /// Puts v between its neighbours, on the side where one of them is. Returns whether that unfolds
  /// something; else v stays.
  bool bring_back(Index v) {
    if (!placement_.is_free(v)) return false;
    Vec3 mean = Vec3::Zero();
    std::vector<Index> nodes;  // of the neighbours
    for (const Index f : around_[v]) {
      for (const Index w : std::as_const(mesh_.faces)[f]) {
        if (w == v) continue;
        mean += mesh_.positions[w];
        nodes.push_back(placement_.node(placement_.seed(w)));
      }
    }
    mean /= static_cast<float>(nodes.size());
    sort_unique(nodes);
    const Place before = place(v);
    Place best = before;
    const float now = lack(v);
    float least = now;
    for (const Index node : nodes) {
      placement_.set_seed(v, {node, before.seed.on_line});
      mesh_.positions[v] = placement_.place(mean, v);
      normals_[v] = placement_.normal(v);
      if (const float left = lack(v); left < least) {
        least = left;
        best = place(v);
      }
    }
    put(v, best);
    return least < now;
  }

 private:
  struct Place {
    Vec3 position, normal;
    Placement::Seed seed;
  };
  Place place(Index v) const { return {mesh_.positions[v], normals_[v], placement_.seed(v)}; }
  void put(Index v, const Place& place) {
    mesh_.positions[v] = place.position;
    normals_[v] = place.normal;
    placement_.set_seed(v, place.seed);
  }

  Vec3 upward(std::span<const Index> face) const {
    Vec3 sum = Vec3::Zero();
    for (const Index v : face) sum += normals_[v];
    return sum;
  }

  /// What the faces around a vertex lack.
  float lack(Index v) const {
    constexpr float good = 0.5f;
    float sum = 0;
    for (const Index f : around_[v]) {
      const auto face = std::as_const(mesh_.faces)[f];
      sum += std::max(0.0f, good - least_sine(face, mesh_.positions, upward(face).normalized()));
    }
    return sum;
  }

  Mesh& mesh_;
  const VertexFaces& around_;
  Placement& placement_;
  std::vector<Vec3>& normals_;
};

}  // namespace

std::vector<Index> unfold(Extraction& extraction, const VertexFaces& around, Placement& placement,
                          std::vector<Vec3>& normals, const std::vector<Index>& folded) {
  Unfolding unfolding(extraction, around, placement, normals);
  std::vector<Index> moved;
  for (const Index v : vertices_of(extraction.mesh, folded)) {
    if (unfolding.bring_back(v)) moved.push_back(v);
  }
  return moved;
}

}  // namespace meshgrain
