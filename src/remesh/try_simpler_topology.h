#pragma once

#include <functional>
#include <string>
#include <vector>

#include "meshgrain/remesh.h"
#include "remesh/flaws.h"

namespace meshgrain {

/// A mesh, and what was learnt while it was made.
struct Made {
  RemeshResult result;
  Faults faults;
  double side;                     // of a face, in the mean
  std::vector<std::string> notes;  // of the input, before there were faces
  Mesh seamed;                     // the input, if seams may be joined; else empty
  bool has_marks;                  // besides those of creases that were found
};

using Make = std::function<Made(Mesh input, const RemeshOptions&, const Context&)>;

/// Whether the surface may change at all: borders and guides that stay, and values of vertices, are
/// those of the surface as it is.
bool may_be_simpler(const RemeshOptions& options);

/// Where faces have faults, what there is of a simpler surface: that is kept, with a note, if it
/// has clearly fewer of them. Topology gives way to validity:
/// - the sides of seams hang together, as of the slits that scans have which were put together of
///   slices, if faces are inverted;
/// - there are no tunnels near the faults that are hardly wider than faces, and far less wide than
///   the surface, as bolt holes of a part may be, or the handles that noise leaves on a scan.
void try_simpler_topology(Made& made, const RemeshOptions& options, const Make& make,
                          const Context& context);

}  // namespace meshgrain
