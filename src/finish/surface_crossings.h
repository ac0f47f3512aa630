#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "finish/projector.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Tells where the surface passes through itself: first place by place, and all over once these are
/// as large as the surface together.
class SurfaceCrossings {
 public:
  /// All must outlive this.
  SurfaceCrossings(const Projector& projector, const Context& context)
      : projector_(projector), context_(context) {}

  /// Whether it does in and across a box, where it hangs together with one of the vertices `from`;
  /// or is too fine there to tell.
  bool any_in(const Eigen::AlignedBox3f& box, std::vector<Index> from);

 private:
  bool any_among(const std::vector<Index>& faces);

  const Projector& projector_;
  const Context& context_;
  std::size_t searched_ = 0;                              // faces
  std::optional<std::vector<std::array<Index, 2>>> all_;  // once they are known
};

}  // namespace meshgrain
