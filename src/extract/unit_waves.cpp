#include "extract/unit_waves.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <utility>

#include "util/sort_unique.h"

namespace meshgrain {

UnitWaves::UnitWaves(const UnitCarrier& carrier, double radius, std::vector<Label>& labels,
                     const Piece& piece)
    : carrier_(carrier),
      radius_(static_cast<float>(radius)),
      reach_(radius_),
      piece_(piece),
      labels_(labels),
      wave_(piece.end - piece.begin, no_index) {}

UnitWaves::UnitWaves(std::span<UnitWaves> pieces, const Context& context)
    : UnitWaves(pieces.front().carrier_, pieces.front().radius_, pieces.front().labels_,
                {pieces.front().piece_.begin, pieces.back().piece_.end}) {
  std::vector<std::uint32_t> first_waves{0};
  for (const UnitWaves& piece : pieces) {
    first_waves.push_back(first_waves.back() + static_cast<std::uint32_t>(piece.waves_.size()));
  }
  context.for_ranges(pieces.size(), 1, [&](std::size_t k, std::size_t) {
    if (first_waves[k] == 0) return;
    const auto [begin, end] = pieces[k].piece_;
    const std::uint32_t last = carrier_.number({4 * end, 0});
    for (std::uint32_t number = carrier_.number({4 * begin, 0}); number < last; ++number) {
      Label& label = labels_[number];
      label = Label::of(label.cost, label.wave() + first_waves[k], label.origin());
    }
  });
  for (std::size_t k = 0; k < pieces.size(); ++k) take_over(std::move(pieces[k]), first_waves[k]);
}

void UnitWaves::take_over(UnitWaves&& piece, std::uint32_t first_wave) {
  for (std::size_t t = 0; t < piece.wave_.size(); ++t) {
    const std::uint32_t wave = piece.wave_[t];
    if (wave != no_index) wave_[piece.piece_.begin - piece_.begin + t] = first_wave + wave;
  }
  for (Wave& wave : piece.waves_) {
    for (Meeting& meeting : wave.nearest) {
      meeting.wave += first_wave;
      if (meeting.other != no_index) meeting.other += first_wave;
    }
    waves_.push_back(std::move(wave));
  }
  for (const std::uint32_t wave : piece.unmet_) unmet_.push_back(first_wave + wave);
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(forgotten_, piece.forgotten_);
  append(beyond_reach_, piece.beyond_reach_);
  sort_unique(piece.beyond_border_);
  for (const std::uint32_t number : piece.beyond_border_) {
    (is_inside(number) ? forgotten_ : beyond_border_).push_back(number);
  }
}

void UnitWaves::start(Index h) {
  const State first = carrier_.state(h, 0);
  wave_from(UnitCarrier::triangle(first)) = static_cast<std::uint32_t>(waves_.size());
  waves_.emplace_back().start = h;
  std::vector<Visit> visits;
  for (int unit = 0; unit < carrier_.units(); ++unit) {
    State out = carrier_.state(h, unit);
    for (int side = 0; side < 3; ++side, out = carrier_.along(out)) step_from_start(out, visits);
  }
  for (const Visit& next : visits) visit(next);
}

void UnitWaves::step_from_start(const State& out, std::vector<Visit>& visits) const {
  if (!carrier_.shortens(out)) return;
  const std::uint32_t wave = wave_from(UnitCarrier::triangle(out));
  step(carrier_.leaving(out), carrier_.across(out), nowhere, wave, visits);
}

void UnitWaves::step(float cost, const State& to, Origin origin, std::uint32_t wave,
                     std::vector<Visit>& visits) const {
  if (!(cost < radius_)) return;
  const std::uint32_t number = carrier_.number(to);
  if (cost < label_at(number).cost) visits.push_back({number, Label::of(cost, wave, origin)});
}

void UnitWaves::visit(const Visit& visit) {
  const auto& [number, next] = visit;
  if (!is_inside(number)) {
    beyond_border_.push_back(number);
    return;
  }
  Label& label = labels_[number];
  if (label.cost <= next.cost) return;
  const bool is_new = label.cost == never || label.wave() != next.wave();
  if (is_new) waves_[next.wave()].places.push_back(number);
  label = next;
  put_in_line({next.cost, number});
}

void UnitWaves::put_in_line(const BucketQueue::Entry& entry) {
  if (entry.cost < reach_) {
    queue_.push(entry.cost, entry.item);
  } else {
    beyond_reach_.push_back(entry);
  }
}

void UnitWaves::set_reach(float reach) {
  reach_ = std::min(reach, radius_);
  for (const BucketQueue::Entry& entry : std::exchange(beyond_reach_, {})) {
    if (label_at(entry.item).cost == entry.cost) put_in_line(entry);
  }
}

/// Whether no cheaper way between the same waves is known. Waves have few neighbours.
bool UnitWaves::is_nearest(const Meeting& meeting) {
  std::vector<Meeting>& nearest = waves_[meeting.wave].nearest;
  const auto same = std::ranges::find(nearest, meeting.other, &Meeting::other);
  if (same == nearest.end()) {
    nearest.push_back(meeting);
    return true;
  }
  if (same->cost <= meeting.cost) return false;
  *same = meeting;
  return true;
}

/// `look(k, steps)` for all of `count` at once, as things are before; then the steps that they say,
/// one after the other, so that the result does not depend on the threads.
template <typename Look>
void UnitWaves::make_steps(std::size_t count, const Look& look, std::vector<Meeting>& meetings,
                           const Context& context) {
  constexpr std::size_t grain = 512;
  const std::size_t parts = (count + grain - 1) / grain;
  if (steps_.size() < parts) steps_.resize(parts);
  context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    Steps& steps = steps_[begin / grain];
    steps.visits.clear();
    steps.contacts.clear();
    for (std::size_t k = begin; k < end; ++k) look(k, steps);
  });
  for (std::size_t k = 0; k < parts; ++k) {
    for (const std::uint32_t number : steps_[k].contacts) meet(carrier_.state(number), meetings);
  }
  for (std::size_t k = 0; k < parts; ++k) {
    for (const Visit& next : steps_[k].visits) visit(next);
  }
}

void UnitWaves::grow(std::vector<Meeting>& meetings, const Context& context) {
  const std::vector<std::uint32_t> forgotten = std::exchange(forgotten_, {});
  const auto come_back = [&](std::size_t k, Steps& steps) {
    come_back_to(forgotten[k], steps.visits);
  };
  make_steps(forgotten.size(), come_back, meetings, context);
  while (queue_.take_bucket(batch_)) {
    context.check();
    const auto go = [&](std::size_t k, Steps& steps) {
      get_ready(k);
      const auto [cost, number] = batch_[k];
      if (cost == label_at(number).cost) go_on(number, steps);  // else another has come since
    };
    make_steps(batch_.size(), go, meetings, context);
  }
  queue_.clear();
  meet_at_contacts(meetings);
}

void UnitWaves::go_on(std::uint32_t number, Steps& steps) const {
  const State in = carrier_.state(number);
  const float cost = label_at(number).cost;
  const std::uint32_t wave = label_at(number).wave();
  if (has_contact(in)) steps.contacts.push_back(number);
  if (wave_from(UnitCarrier::triangle(in)) == wave || carrier_.gain(in)) return;
  const auto costs = carrier_.passing(in);
  State out = in;
  for (std::size_t side = 0; side < 2; ++side) {
    out = carrier_.along(out);
    step(cost + costs[side], carrier_.across(out), side == 0 ? previous_edge : edge_before, wave,
         steps.visits);
  }
}

/// Waves jump about in memory: fetches what will be looked at in a few steps.
void UnitWaves::get_ready(std::size_t place) const {
  if (place + 8 >= batch_.size()) return;
  const std::uint32_t later = batch_[place + 8].item;
  hwy::Prefetch(&label_at(later));
  carrier_.prefetch(carrier_.state(later));
  const State soon = carrier_.state(batch_[place + 4].item);
  const State next = carrier_.along(soon), last = carrier_.along(next);
  for (const State& out : {carrier_.opposite(soon), next, last}) {
    hwy::Prefetch(&label_at(carrier_.number(carrier_.across(out))));
  }
}

/// Whether another wave has come the other way through the same edge, or this one could end.
bool UnitWaves::has_contact(const State& in) const {
  const Label& label = label_at(carrier_.number(in));
  const Label& other = label_at(carrier_.number(carrier_.across(carrier_.opposite(in))));
  return (other.cost < never && other.wave() != label.wave()) || carrier_.gain(in) == 0;
}

void UnitWaves::meet(const State& in, std::vector<Meeting>& meetings) {
  const std::uint32_t here = carrier_.number(in);
  const std::uint32_t there = carrier_.number(carrier_.across(carrier_.opposite(in)));
  const Label &label = label_at(here), &other = label_at(there);
  if (other.cost < never && other.wave() != label.wave()) {
    // Both have paid for the edge.
    const float cost = label.cost + other.cost - carrier_.crossing(carrier_.across(in));
    const auto [older, newer] = std::minmax({label.wave(), other.wave()});
    waves_[newer].contacts.push_back(label.wave() == newer ? here : there);
    const Meeting meeting{here, there, label.cost, other.cost, cost, newer, older};
    if (is_nearest(meeting)) meetings.push_back(meeting);
  }
  // Other Burgers vectors have a wave of their own.
  if (carrier_.gain(in) != 0) return;
  const float cost = label.cost + carrier_.ending(in);
  if (cost == UnitCarrier::forbidden) return;
  waves_[label.wave()].contacts.push_back(here);
  const Meeting meeting{here, no_index, label.cost, 0, cost, label.wave(), no_index};
  if (is_nearest(meeting)) meetings.push_back(meeting);
}

void UnitWaves::take_back(Index h) {
  const std::uint32_t wave =
      std::exchange(wave_from(UnitCarrier::triangle(carrier_.state(h, 0))), no_index);
  std::exchange(waves_[wave].nearest, {});
  std::exchange(waves_[wave].contacts, {});
  for (const std::uint32_t number : std::exchange(waves_[wave].places, {})) {
    if (label_at(number).wave() == wave) forget(number);
  }
}

void UnitWaves::look_again(Index h) {
  for (int unit = 0; unit < carrier_.units(); ++unit) {
    State in = carrier_.state(h, unit);
    for (int side = 0; side < 3; ++side, in = carrier_.along(in)) {
      const std::uint32_t number = carrier_.number(in);
      if (label_at(number).cost < never) {
        forget_beyond(number);
        queue_.push(label_at(number).cost, number);
      }
      const std::uint32_t seed = carrier_.number(carrier_.across(in));
      if (!is_inside(seed)) {
        beyond_border_.push_back(seed);
        continue;
      }
      if (label_at(seed).cost < never && label_at(seed).origin() == nowhere) {
        forget_beyond(seed);
        forget(seed);
      } else if (wave_from(UnitCarrier::triangle(in)) != no_index) {
        forgotten_.push_back(seed);  // it may now be cheaper to start there
      }
    }
  }
}

void UnitWaves::meet_again(const Meeting& meeting) {
  std::vector<Meeting>& nearest = waves_[meeting.wave].nearest;
  const auto same = std::ranges::find(nearest, meeting.other, &Meeting::other);
  const bool stands = same != nearest.end() && same->here == meeting.here &&
                      same->there == meeting.there && same->cost == meeting.cost;
  if (!stands) return;  // another one of the same two waves does
  nearest.erase(same);
  unmet_.push_back(meeting.wave);
}

void UnitWaves::meet_at_contacts(std::vector<Meeting>& meetings) {
  std::vector<std::uint32_t> waves = std::exchange(unmet_, {});
  sort_unique(waves);
  for (const std::uint32_t wave : waves) {
    std::vector<std::uint32_t> contacts = std::exchange(waves_[wave].contacts, {});
    sort_unique(contacts);
    for (const std::uint32_t number : contacts) {
      const Label& label = label_at(number);
      if (label.cost < never && label.wave() == wave) meet(carrier_.state(number), meetings);
    }
  }
}

void UnitWaves::forget(std::uint32_t number) {
  if (label_at(number).cost == never) return;
  labels_[number].cost = never;
  forgotten_.push_back(number);
}

/// What has come by way of a state.
void UnitWaves::forget_beyond(std::uint32_t number) {
  std::vector<std::uint32_t> from{number};
  while (!from.empty()) {
    State out = carrier_.state(from.back());
    const std::uint32_t wave = label_at(from.back()).wave();
    from.pop_back();
    for (const Origin origin : {previous_edge, edge_before}) {
      out = carrier_.along(out);
      if (carrier_.halfedge(out) == no_index) break;  // outside there is one side
      const std::uint32_t next = carrier_.number(carrier_.across(out));
      const Label& label = label_at(next);
      if (label.cost == never || label.wave() != wave || label.origin() != origin) continue;
      forget(next);
      from.push_back(next);
    }
  }
}

/// By the waves that are beside it.
void UnitWaves::come_back_to(std::uint32_t number, std::vector<Visit>& visits) const {
  const State out = carrier_.across(carrier_.state(number));
  if (!is_inside(carrier_.number(out))) return;
  const std::uint32_t triangle = UnitCarrier::triangle(out);
  if (wave_from(triangle) != no_index) step_from_start(out, visits);
  State in = out;
  for (std::size_t side = 0; side < 2; ++side) {
    in = carrier_.back(in);
    const Label& label = label_at(carrier_.number(in));
    if (label.cost == never || wave_from(triangle) == label.wave() || carrier_.gain(in)) continue;
    step(label.cost + carrier_.passing(in)[side], carrier_.across(out),
         side == 0 ? previous_edge : edge_before, label.wave(), visits);
  }
}

std::optional<UnitWaves::Ends> UnitWaves::ends(const Meeting& meeting) const {
  const Label& here = label_at(meeting.here);
  if (here.cost != meeting.here_cost) return std::nullopt;
  if (meeting.there == no_index) {
    const bool stands = meeting.cost == here.cost + carrier_.ending(carrier_.state(meeting.here));
    return stands ? std::optional<Ends>({waves_[here.wave()].start, no_index}) : std::nullopt;
  }
  const Label& there = label_at(meeting.there);
  if (there.cost != meeting.there_cost || there.wave() == here.wave()) return std::nullopt;
  return Ends{waves_[here.wave()].start, waves_[there.wave()].start};
}

std::vector<UnitCarrier::State> UnitWaves::way(std::uint32_t number) const {
  std::vector<State> steps;
  for (const std::uint32_t wave = label_at(number).wave();;) {
    const Label& label = label_at(number);
    const State out = carrier_.across(carrier_.state(number));
    steps.push_back(out);
    if (label.origin() == nowhere) return steps;
    State in = carrier_.back(out);
    if (label.origin() == edge_before) in = carrier_.back(in);
    number = carrier_.number(in);
    if (label_at(number).wave() != wave || !(label_at(number).cost < label.cost)) return {};
  }
}

}  // namespace meshgrain
