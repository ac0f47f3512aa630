#pragma once

#include "remesh/remaking.h"

namespace meshgrain {

/// Where faces have faults, what there is of a simpler surface: that is kept, with a note, if it
/// has clearly fewer of them. Topology gives way to validity:
/// - the sides of seams hang together, as of the slits that scans have which were put together of
///   slices, if faces are inverted;
/// - there are no tunnels near the faults that are hardly wider than faces, and far less wide than
///   the surface, as bolt holes of a part may be, or the handles that noise leaves on a scan.
void try_simpler_topology(Made& made, const RemeshOptions& options, const Make& make,
                          const Context& context);

}  // namespace meshgrain
