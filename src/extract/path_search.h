#pragma once

#include <cstdint>
#include <vector>

#include "extract/unit_carrier.h"
#include "util/bucket_queue.h"

namespace meshgrain {

/// Dijkstra's algorithm over the triangles of a lattice mesh, for the cheapest way to take a unit
/// from the Burgers vector of one of them to another place.
class PathSearch {
 public:
  /// `most`: what may be spent for each irregular vertex that goes.
  PathSearch(const UnitCarrier& carrier, double most);

  struct Path {
    std::vector<UnitCarrier::State> steps;  // what leaves through which edges, the last one first
    double cost = 0;                        // for each irregular vertex that goes
    std::vector<std::uint32_t> regions;     // where something was looked at
  };

  /// A few triangles near each other, so that what a search has looked at is a short list.
  static std::uint32_t region(Index h) { return h / 16; }

  /// From the triangle left of h; without any steps if there is none. It is the same whatever was
  /// searched before.
  Path from(Index h);

 private:
  using State = UnitCarrier::State;
  enum Origin : std::uint32_t { previous_edge, edge_before, nowhere };
  struct Visit {
    float cost = 0;
    std::uint32_t when = 0;  // four times the search in which this was so, and where it came from
  };

  void visit(float cost, const State& to, Origin origin);

  const UnitCarrier& carrier_;
  double most_;
  std::vector<Visit> visits_;               // of each state
  std::vector<std::uint32_t> last_search_;  // of each region
  BucketQueue queue_{UnitCarrier::least_step};
  std::uint32_t search_ = 0;
  double bound_ = 0;  // paths that cost more are of no use
};

}  // namespace meshgrain
