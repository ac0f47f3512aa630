#pragma once

#include <span>

#include "meshgrain/mesh.h"

namespace meshgrain::made {

/// A kernel's step for a single node.
template <typename Kernel>
Vec3 relaxed(const Kernel& kernel, Index i, const Vec3* field) {
  Vec3 value;
  kernel.relax(std::span<const Index>(&i, 1), field, &value);
  return value;
}

}  // namespace meshgrain::made
