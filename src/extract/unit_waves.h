#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "extract/unit_carrier.h"
#include "util/bucket_queue.h"

namespace meshgrain {

/// Where singular triangles could carry units of their Burgers vectors most cheaply: waves go out
/// from all of them over the lattice mesh, and where two meet is a way for them to cancel each
/// other. Each place belongs to the wave that comes first, so that together they take no longer
/// than one wave over everything (Dijkstra's algorithm from many sources).
///
/// Waves may be kept within a piece of the mesh, so that those of several pieces can grow, and be
/// followed, at once: they look at nothing beyond its border.
class UnitWaves {
 public:
  using State = UnitCarrier::State;

  enum Origin : std::uint32_t { previous_edge, edge_before, nowhere };
  static constexpr float never = std::numeric_limits<float>::infinity();

  /// What came to a state, of which wave, from where, and at what cost.
  struct Label {
    float cost = never;
    std::uint32_t packed = 0;

    static Label of(float cost, std::uint32_t wave, Origin origin) {
      return {cost, 4 * wave + origin};
    }
    std::uint32_t wave() const { return packed / 4; }
    Origin origin() const { return static_cast<Origin>(packed % 4); }
  };

  /// Triangles, as the carrier numbers them.
  struct Piece {
    std::uint32_t begin, end;
  };

  /// `radius`: the cost at which waves end. `labels`: of all states of the carrier, those of the
  /// piece still unreached; they must outlive this.
  UnitWaves(const UnitCarrier& carrier, double radius, std::vector<Label>& labels,
            const Piece& piece);

  /// Takes over the waves of pieces that lie one behind the other. They go on over the borders in
  /// between when they grow again.
  UnitWaves(std::span<UnitWaves> pieces, const Context& context);

  /// A place where a unit of one wave could meet one of another, or end for good.
  struct Meeting {
    std::uint32_t here, there;  // states; `there` is no_index at an end
    float here_cost, there_cost;
    float cost;                 // of the whole way
    std::uint32_t wave, other;  // `other` is no_index at an end
  };

  /// Sends a wave out from the triangle left of h.
  void start(Index h);

  /// Until the next call waves end at this cost already. Ways between two of them that cost less
  /// than twice as much are then found, but for a few with a dear step in their middle.
  void set_reach(float reach);
  /// Whether none would go on beyond the reach.
  bool are_grown() const { return beyond_reach_.empty(); }

  /// Lets waves go on as far as they come, and says where they meet: of each two, the places that
  /// were cheaper than those before.
  void grow(std::vector<Meeting>& meetings, const Context& context);

  /// Takes back the wave that has started at h, so that the others can come there.
  void take_back(Index h);

  /// The triangle left of h has changed: waves must find their way through it again.
  void look_again(Index h);

  /// If both waves of a meeting are still there, though not at that place any more, grow() will say
  /// where else they meet.
  void meet_again(const Meeting& meeting);

  /// Of a meeting that still is one: where the two waves, or one, started. Nothing if things have
  /// changed.
  struct Ends {
    Index from, to;  // `to` is no_index where a single wave ends
  };
  std::optional<Ends> ends(const Meeting& meeting) const;

  /// What leaves through which edges, from the start of a wave to a state, the last one first;
  /// nothing where another wave, which itself went no farther, has come in between.
  std::vector<State> way(std::uint32_t number) const;

 private:
  static constexpr float bucket = 0.5f;  // of costs that are looked at together

  struct Wave {
    Index start = no_index;               // a halfedge
    std::vector<std::uint32_t> places;    // states that were its own once
    std::vector<Meeting> nearest;         // with each older wave
    std::vector<std::uint32_t> contacts;  // states where it has met older ones, or could end
  };

  /// A state that a wave could come to.
  struct Visit {
    std::uint32_t number;
    Label label;
  };
  /// What a part of the waves would do next.
  struct Steps {
    std::vector<Visit> visits;
    std::vector<std::uint32_t> contacts;  // states where waves may meet, or end
  };

  template <typename Look>
  void make_steps(std::size_t count, const Look& look, std::vector<Meeting>& meetings,
                  const Context& context);
  void get_ready(std::size_t place) const;
  void go_on(std::uint32_t number, Steps& steps) const;
  bool has_contact(const State& in) const;
  void meet(const State& in, std::vector<Meeting>& meetings);
  void meet_at_contacts(std::vector<Meeting>& meetings);
  bool is_nearest(const Meeting& meeting);
  void step(float cost, const State& to, Origin origin, std::uint32_t wave,
            std::vector<Visit>& visits) const;
  void step_from_start(const State& out, std::vector<Visit>& visits) const;
  void visit(const Visit& visit);
  void put_in_line(const BucketQueue::Entry& entry);
  bool is_inside(std::uint32_t number) const {
    const std::uint32_t triangle = UnitCarrier::triangle(carrier_.state(number));
    return piece_.begin <= triangle && triangle < piece_.end;
  }
  const Label& label_at(std::uint32_t number) const {
    return is_inside(number) ? labels_[number] : unreached_;
  }
  std::uint32_t& wave_from(std::uint32_t triangle) { return wave_[triangle - piece_.begin]; }
  std::uint32_t wave_from(std::uint32_t triangle) const { return wave_[triangle - piece_.begin]; }
  void take_over(UnitWaves&& piece, std::uint32_t first_wave);

  void forget(std::uint32_t number);
  void forget_beyond(std::uint32_t number);
  void come_back_to(std::uint32_t number, std::vector<Visit>& visits) const;

  const UnitCarrier& carrier_;
  float radius_, reach_;
  Piece piece_;
  std::vector<Label>& labels_;       // of each state
  Label unreached_;                  // of all beyond the border
  std::vector<std::uint32_t> wave_;  // of each triangle: the one that starts there
  std::vector<Wave> waves_;
  std::vector<std::uint32_t> forgotten_;          // states that waves could come back to
  std::vector<std::uint32_t> beyond_border_;      // states that they could come to from here
  std::vector<std::uint32_t> unmet_;              // waves that must look at their contacts again
  std::vector<BucketQueue::Entry> beyond_reach_;  // states
  BucketQueue queue_{bucket};
  std::vector<BucketQueue::Entry> batch_;
  std::vector<Steps> steps_;  // kept for their memory
};

}  // namespace meshgrain
