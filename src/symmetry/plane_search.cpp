#include "symmetry/plane_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "meshgrain/surface.h"
#include "util/bounding_box.h"

namespace meshgrain {
namespace {

constexpr std::size_t sample_count = 10000;

double center_of_area(const Mesh& mesh, int axis) {
  double sum = 0, total = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const double area = face_area(mesh, f);
    double middle = 0;
    for (const Index v : mesh.faces[f]) middle += mesh.positions[v][axis];
    sum += area * middle / static_cast<double>(mesh.faces.degree(f));
    total += area;
  }
  return total > 0 ? sum / total : 0;
}

}  // namespace

PlaneSearch::PlaneSearch(const Mesh& mesh, const Context& context)
    : mesh_(mesh),
      box_(bounding_box(mesh.positions, context)),
      samples_(mesh, sample_count),
      tree_(mesh) {}

/// How far the mirror image about a plane is from the mesh.
MirrorPlane PlaneSearch::measure(int axis, double offset, const Context& context) const {
  // Where it is far a few samples tell.
  constexpr std::size_t few = 8;
  constexpr double large = 0.02;
  const MirrorPlane rough = measure(axis, offset, few, context);
  return rough.mismatch > large ? rough : measure(axis, offset, 1, context);
}

/// By every so manieth sample.
MirrorPlane PlaneSearch::measure(int axis, double offset, std::size_t step,
                                 const Context& context) const {
  constexpr std::size_t grain = 256;
  constexpr double far = 0.02;  // see MirrorPlane::unlike
  const double diagonal = box_.diagonal().cast<double>().norm();
  const std::size_t count = (samples_.size() + step - 1) / step;
  std::vector<double> distances(count);  // over the diagonal
  context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      Eigen::Vector3d p = samples_[k * step];
      p[axis] = 2 * offset - p[axis];
      distances[k] = std::sqrt(tree_.closest(p).squared_distance) / diagonal;
    }
  });
  const double sum = std::accumulate(distances.begin(), distances.end(), 0.0);
  const auto unlike = std::ranges::count_if(distances, [](double d) { return d > far; });
  const auto all = static_cast<double>(count);
  return {axis, offset, sum / all, static_cast<double>(unlike) / all};
}

MirrorPlane PlaneSearch::find(int axis, const Context& context) const {
  const MirrorPlane middle =
      measure(axis, (double{box_.min()[axis]} + box_.max()[axis]) / 2, context);
  const MirrorPlane center = measure(axis, center_of_area(mesh_, axis), context);
  return center.mismatch < middle.mismatch ? center : middle;
}

MirrorPlane find_mirror_plane(const Mesh& mesh, int axis, const Context& context) {
  return PlaneSearch(mesh, context).find(axis, context);
}

}  // namespace meshgrain
