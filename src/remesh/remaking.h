#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mesh/cut_apart.h"
#include "meshgrain/remesh.h"
#include "remesh/flaws.h"
#include "remesh/stages.h"

namespace meshgrain {

/// A mesh, and what was learnt while it was made.
struct Made {
  RemeshResult result;
  Faults faults;
  double side = 0;                 // of a face, in the mean
  std::vector<std::string> notes;  // of the input, before there were faces
  Mesh seamed;                     // the input, if seams may be joined; else empty
  bool has_marks = false;          // besides those of creases that were found
  bool was_marked = false;         // the input
  Mesh roundings;                  // of the input, which are sharp so far
  Cuts cuts;                       // of the surface that was remeshed
  double room_for_creases = 0;     // those with less were left out (see Pipeline)
  bool follows_creases = false;    // that nobody asked for; only told if faces are inverted

  /// What was remeshed, to be so once more: joined again where it was cut, and with the marks that
  /// it came with alone.
  Mesh surface() const;
  /// The same, but as it was cut.
  Mesh surface_in_pieces() const;
  bool is_without_creases() const { return std::isinf(room_for_creases); }
  /// Whether so many faces pass through each other that little can be seen of what the surface is:
  /// fewer are no reason to change it.
  bool has_many_crossings() const { return are_many(faults.crossings); }
  bool are_many(std::size_t crossings) const {
    return crossings > result.mesh.faces.size() / Flaws::many;
  }
  bool has_serious_faults() const { return faults.inverted > 0 || has_many_crossings(); }
};

/// What a mesh must be to be of use.
struct Wanted {
  FaultCounts fewer_than;
  bool with_creases;  // with some of them, at least
};

/// Makes a mesh, of use for nothing else if anything is wanted of it.
using Make = std::function<Made(Mesh input, const RemeshOptions&, const std::optional<Wanted>&,
                                const Context&)>;

/// Whether another surface may take the place of this one, or faces of other sizes: borders and
/// guides that stay, and values of vertices, are those of the surface as it is.
bool may_remake(const RemeshOptions& options);

/// Others in place of a mesh that has faults.
class Remaking {
 public:
  /// All that it is given must outlive it.
  Remaking(Made& made, const RemeshOptions& options, const Make& make, const Context& context);
  /// The report has the times of all, also of what came to nothing.
  ~Remaking() { made_.result.report.stages = std::move(times_); }
  Remaking(const Remaking&) = delete;
  Remaking& operator=(const Remaking&) = delete;

  /// As they were given, with the number of faces or vertices that was made if none was asked for.
  const RemeshOptions& options() const { return options_; }
  /// For what is done in between.
  Stages& stage() { return stage_; }

  /// What there is of another surface than that of `before`, with a note of why. The report tells
  /// of the input as it was.
  Made made_of(Mesh surface, const RemeshOptions& options, const Made& before,
               const std::string& note);

  /// The same with no creases, nor marked edges.
  Made made_without_creases(Mesh surface, const Made& before, const std::string& note);

  /// If it has clearly fewer faults. Returns whether it has.
  bool keep_if_better(Made other);

  /// From now on those of other surfaces have creases if there are any now.
  void keep_creases() { keeps_creases_ = !made_.is_without_creases(); }

 private:
  Made& made_;
  RemeshOptions options_;
  const Make& make_;
  const Context& context_;
  std::vector<StageTime> times_;
  Stages stage_;
  bool keeps_creases_ = false;
};

}  // namespace meshgrain
