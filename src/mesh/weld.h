#pragma once

#include <cstddef>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Merges vertices whose positions are exactly equal, in time linear in their number. Those that
/// remain keep the order in which they first appear, the value of the first and the mean of the
/// normals. Faces are kept, even those that become degenerate. Returns the number of vertices that
/// were merged into others.
std::size_t weld(Mesh& mesh);

/// Sets coordinates to zero that are nothing but rounding, less than a billionth of the mesh's
/// size: the sine of a full turn is not that of none.
void drop_rounding(Mesh& mesh, const Context& context);

/// Whether the faces of a mesh hardly share vertices although they meet, as some programs write
/// them: fewer than half of its vertices have a place of their own. (Seams leave more than half,
/// and so do the two sides of a sheet.) Costs nothing where faces do share vertices.
bool is_torn(const Mesh& mesh);

/// Numbers distinct positions in the order in which they first appear: a hash table with open
/// addressing over the positions themselves.
class DistinctPositions {
 public:
  /// The number of `p`, a new one if it was not seen before.
  Index add(const Vec3& p);

  const std::vector<Vec3>& positions() const { return positions_; }
  std::vector<Vec3> take() { return std::move(positions_); }

 private:
  void grow();
  std::size_t find(const Vec3& p) const;

  std::vector<Vec3> positions_;
  std::vector<Index> slots_;  // a power of two of them, at most half of them taken
};

}  // namespace meshgrain
