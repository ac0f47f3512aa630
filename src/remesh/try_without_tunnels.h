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
  bool has_marks;                  // besides those of creases that were found
};

using Make = std::function<Made(Mesh input, const RemeshOptions&, const Context&)>;

/// Where faces have faults at tunnels that are hardly wider than they are, and far less wide than
/// the surface, as bolt holes of a part may be, or the handles that noise leaves on a scan, what
/// there is without these tunnels: that is kept, with a note, if it has clearly fewer faults.
/// Topology gives way to validity.
void try_without_tunnels(Made& made, const RemeshOptions& options, const Make& make,
                         const Context& context);

}  // namespace meshgrain
