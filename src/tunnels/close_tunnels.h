#pragma once

#include <cstddef>
#include <span>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Closes tunnels through a solid, such as bolt holes, and handles no larger than these, as noise
/// makes them: the surface around a loop of at most that length goes, as far as the tunnel is about
/// as narrow, and a lid is put on either end. Only loops near some vertices are looked for; but
/// where most of the holes that are no wider than those go, the others do, too.
/// Limbs and larger handles stay: no piece of the surface comes to be, or falls apart. Tunnels that
/// another piece goes through stay as well. Vertices that no face uses any more go. Returns how
/// many were closed; `triangles` is manifold there, and stays so.
std::size_t close_tunnels(Mesh& triangles, std::span<const Index> near, double longest,
                          const Context& context);

}  // namespace meshgrain
