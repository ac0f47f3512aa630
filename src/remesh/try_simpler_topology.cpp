#include "remesh/try_simpler_topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "meshgrain/statistics.h"
#include "remesh/try_joined_seams.h"
#include "tunnels/close_tunnels.h"

namespace meshgrain {
namespace {

class SimplerTopology {
 public:
  SimplerTopology(Made& made, const RemeshOptions& options, const Make& make,
                  const Context& context)
      : made_(made), remaking_(made, options, make, context), context_(context) {}

  void run() {
    Mesh seamed = std::exchange(made_.seamed, {});
    Made before = made_;
    if (!seamed.faces.empty()) join_seams(std::move(seamed), before);
    close_tunnels(before, Pieces::meet);
    // Tunnels alone do not help where pieces crowd each other, nor does it to leave these apart.
    const bool any_meet = !before.cuts.empty();
    if (any_meet && made_.has_serious_faults()) close_tunnels(before, Pieces::are_apart);
  }

 private:
  /// Those of a surface that is not manifold.
  enum class Pieces { meet, are_apart };

  /// Tunnels may be too narrow all the same: `before` becomes what there is without seams.
  void join_seams(Mesh surface, Made& before) {
    // The two sides of a seam mostly cross a little: that alone is no reason to join them.
    if (before.faults.inverted == 0) return;
    before = made_without_seams(remaking_, std::move(surface), before);
    remaking_.keep_if_better(before);
  }

  void close_tunnels(const Made& before, Pieces pieces) {
    constexpr double of_diagonal = 0.25;  // a wider tunnel is what the shape is about
    const double longest = of_diagonal * bounding_diagonal(before.result.fields.surface);
    std::size_t closed_before = 0;
    const Faults& faults = before.faults;
    const std::vector<Index>& near =
        before.has_many_crossings() ? faults.nodes : faults.nodes_of_inverted;
    // How many sides of faces are around the widest tunnels that are closed.
    for (const double sides_around : {4.0, 6.0}) {
      if (!made_.has_serious_faults()) break;
      Mesh surface = pieces == Pieces::meet ? before.surface() : before.surface_in_pieces();
      const double most = std::min(sides_around * before.side, longest);
      const std::size_t closed = remaking_.stage()(
          "tunnels", [&] { return meshgrain::close_tunnels(surface, near, most, context_); });
      constexpr double considerably = 1.05;  // else it would be about the same once more
      const bool are_more =
          static_cast<double>(closed) > considerably * static_cast<double>(closed_before);
      if (!are_more) continue;
      closed_before = closed;
      keep_if_better(std::move(surface), before, pieces, closed);
    }
  }

  /// Or without creases, if it follows some and has inverted faces.
  void keep_if_better(Mesh surface, const Made& before, Pieces pieces, std::size_t closed) {
    const auto note = [&](const char* also) {
      return fmt::format(
          "closed {} {}{}{}: faces of this size around {} would be inverted or pass through each "
          "other",
          closed, closed == 1 ? "tunnel" : "tunnels",
          pieces == Pieces::meet ? "" : ", left pieces apart where the surface is not manifold",
          also, closed == 1 ? "it" : "them");
    };
    Made other = made_of(surface, before, note(""));
    const bool creases_may_go = other.follows_creases && other.faults.inverted > 0;
    remaking_.keep_if_better(std::move(other));
    if (!creases_may_go || made_.faults.inverted == 0) return;
    const char* also =
        before.was_marked ? ", without creases and marked edges" : ", without creases";
    remaking_.keep_if_better(
        remaking_.made_without_creases(std::move(surface), before, note(also)));
  }

  Made made_of(Mesh surface, const Made& before, const std::string& note) {
    return remaking_.made_of(std::move(surface), remaking_.options(), before, note);
  }

  Made& made_;
  Remaking remaking_;
  const Context& context_;
};

}  // namespace

void try_simpler_topology(Made& made, const RemeshOptions& options, const Make& make,
                          const Context& context) {
  const bool is_cloud = made.result.fields.surface.is_point_cloud();
  if (is_cloud || !may_remake(options) || !made.has_serious_faults()) return;
  SimplerTopology(made, options, make, context).run();
}

}  // namespace meshgrain
