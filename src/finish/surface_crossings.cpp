#include "finish/surface_crossings.h"

#include <algorithm>
#include <utility>

#include "measure/crossings.h"
#include "mesh/part.h"

namespace meshgrain {

bool SurfaceCrossings::any_in(const Eigen::AlignedBox3f& box, std::vector<Index> from) {
  constexpr std::size_t most_searched = 20000;
  const Mesh& surface = projector_.surface();
  if (surface.is_point_cloud()) return false;
  if (all_ && all_->empty() && surface.faces.size() <= most_searched) return false;
  const auto faces = projector_.faces_in(box, std::move(from), most_searched);
  return !faces || any_among(*faces);
}

bool SurfaceCrossings::any_among(const std::vector<Index>& faces) {
  const Mesh& surface = projector_.surface();
  searched_ += faces.size();
  if (!all_ && searched_ > surface.faces.size()) all_ = find_crossings(surface, context_);
  if (!all_) return !find_crossings(part_of(surface, faces).mesh, context_).empty();
  return std::ranges::any_of(faces, [&](Index f) {
    const auto of_face =
        std::ranges::equal_range(*all_, f, {}, [](const auto& pair) { return pair[0]; });
    return std::ranges::any_of(
        of_face, [&](const auto& pair) { return std::ranges::binary_search(faces, pair[1]); });
  });
}

}  // namespace meshgrain
