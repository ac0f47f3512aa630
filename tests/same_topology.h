#pragma once

#include <gtest/gtest.h>

#include "meshgrain/statistics.h"

namespace meshgrain::made {

/// What is promised of the mesh made from one that is manifold and orientable.
inline void expect_same_topology(const MeshStatistics& after, const MeshStatistics& before) {
  EXPECT_EQ(after.components, before.components);
  EXPECT_EQ(after.boundary_loops, before.boundary_loops);
  EXPECT_EQ(after.euler, before.euler);
  EXPECT_EQ(after.non_manifold_edges, 0u);
  EXPECT_EQ(after.non_manifold_vertices, 0u);
  EXPECT_EQ(after.isolated_vertices, 0u);
}

}  // namespace meshgrain::made
