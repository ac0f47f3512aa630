#include "extract/unit_waves.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "util/sort_unique.h"

namespace meshgrain {

UnitWaves::UnitWaves(const UnitCarrier& carrier, double radius)
    : carrier_(carrier),
      radius_(static_cast<float>(radius)),
      reach_(radius_),
      labels_(carrier.states()),
      wave_(carrier.triangles(), no_index) {}

void UnitWaves::start(Index h) {
  const State first = carrier_.state(h, 0);
  wave_[UnitCarrier::triangle(first)] = static_cast<std::uint32_t>(starts_.size());
  starts_.push_back(h);
  places_.emplace_back();
  nearest_.emplace_back();
  contacts_.emplace_back();
  std::vector<Visit> visits;
  for (int unit = 0; unit < carrier_.units(); ++unit) {
    State out = carrier_.state(h, unit);
    for (int side = 0; side < 3; ++side, out = carrier_.along(out)) step_from_start(out, visits);
  }
  for (const Visit& next : visits) visit(next);
}

void UnitWaves::step_from_start(const State& out, std::vector<Visit>& visits) const {
  if (!carrier_.shortens(out)) return;
  const std::uint32_t wave = wave_[UnitCarrier::triangle(out)];
  step(carrier_.leaving(out), carrier_.across(out), nowhere, wave, visits);
}

void UnitWaves::step(float cost, const State& to, Origin origin, std::uint32_t wave,
                     std::vector<Visit>& visits) const {
  if (!(cost < radius_)) return;
  const std::uint32_t number = carrier_.number(to);
  if (cost < labels_[number].cost) visits.push_back({number, Label::of(cost, wave, origin)});
}

void UnitWaves::visit(const Visit& visit) {
  const auto& [number, next] = visit;
  Label& label = labels_[number];
  if (label.cost <= next.cost) return;
  const bool is_new = label.cost == never || label.wave() != next.wave();
  if (is_new) places_[next.wave()].push_back(number);
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
    if (labels_[entry.item].cost == entry.cost) put_in_line(entry);
  }
}

/// Whether no cheaper way between the same waves is known. Waves have few neighbours.
bool UnitWaves::is_nearest(const Meeting& meeting) {
  std::vector<Meeting>& nearest = nearest_[meeting.wave];
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
  std::vector<Steps> parts((count + grain - 1) / grain);
  context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) look(k, parts[begin / grain]);
  });
  for (const Steps& steps : parts) {
    for (const std::uint32_t number : steps.contacts) meet(carrier_.state(number), meetings);
  }
  for (const Steps& steps : parts) {
    for (const Visit& next : steps.visits) visit(next);
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
    sort_by_place();
    const auto go = [&](std::size_t k, Steps& steps) {
      get_ready(k);
      const auto [cost, number] = batch_[k];
      if (cost == labels_[number].cost) go_on(number, steps);  // else another has come since
    };
    make_steps(batch_.size(), go, meetings, context);
  }
  queue_.clear();
  meet_at_contacts(meetings);
}

void UnitWaves::go_on(std::uint32_t number, Steps& steps) const {
  const State in = carrier_.state(number);
  const float cost = labels_[number].cost;
  const std::uint32_t wave = labels_[number].wave();
  if (has_contact(in)) steps.contacts.push_back(number);
  if (wave_[UnitCarrier::triangle(in)] == wave || carrier_.gain(in)) return;
  const auto costs = carrier_.passing(in);
  State out = in;
  for (std::size_t side = 0; side < 2; ++side) {
    out = carrier_.along(out);
    step(cost + costs[side], carrier_.across(out), side == 0 ? previous_edge : edge_before, wave,
         steps.visits);
  }
}

/// Roughly in the order of the states in memory, so that what is beside each other finds the same
/// lines in the cache.
void UnitWaves::sort_by_place() {
  constexpr std::uint32_t places = 512;
  const std::size_t width = labels_.size() / places + 1;
  std::array<std::uint32_t, places + 1> starts{};
  for (const auto& entry : batch_) ++starts[entry.item / width + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  sorted_.resize(batch_.size());
  for (const auto& entry : batch_) sorted_[starts[entry.item / width]++] = entry;
  batch_.swap(sorted_);
}

/// Waves jump about in memory: fetches what will be looked at in a few steps.
void UnitWaves::get_ready(std::size_t place) const {
  if (place + 8 >= batch_.size()) return;
  const std::uint32_t later = batch_[place + 8].item;
  hwy::Prefetch(&labels_[later]);
  carrier_.prefetch(carrier_.state(later));
  const State soon = carrier_.state(batch_[place + 4].item);
  const State next = carrier_.along(soon), last = carrier_.along(next);
  for (const State& out : {carrier_.opposite(soon), next, last}) {
    hwy::Prefetch(&labels_[carrier_.number(carrier_.across(out))]);
  }
}

/// Whether another wave has come the other way through the same edge, or this one could end.
bool UnitWaves::has_contact(const State& in) const {
  const Label& label = labels_[carrier_.number(in)];
  const Label& other = labels_[carrier_.number(carrier_.across(carrier_.opposite(in)))];
  return (other.cost < never && other.wave() != label.wave()) || carrier_.gain(in) == 0;
}

void UnitWaves::meet(const State& in, std::vector<Meeting>& meetings) {
  const std::uint32_t here = carrier_.number(in);
  const std::uint32_t there = carrier_.number(carrier_.across(carrier_.opposite(in)));
  const Label &label = labels_[here], &other = labels_[there];
  if (other.cost < never && other.wave() != label.wave()) {
    // Both have paid for the edge.
    const float cost = label.cost + other.cost - carrier_.crossing(carrier_.across(in));
    const auto [older, newer] = std::minmax({label.wave(), other.wave()});
    contacts_[newer].push_back(label.wave() == newer ? here : there);
    const Meeting meeting{here, there, label.cost, other.cost, cost, newer, older};
    if (is_nearest(meeting)) meetings.push_back(meeting);
  }
  // Other Burgers vectors have a wave of their own.
  if (carrier_.gain(in) != 0) return;
  const float cost = label.cost + carrier_.ending(in);
  if (cost == UnitCarrier::forbidden) return;
  contacts_[label.wave()].push_back(here);
  const Meeting meeting{here, no_index, label.cost, 0, cost, label.wave(), no_index};
  if (is_nearest(meeting)) meetings.push_back(meeting);
}

void UnitWaves::take_back(Index h) {
  const std::uint32_t wave =
      std::exchange(wave_[UnitCarrier::triangle(carrier_.state(h, 0))], no_index);
  std::exchange(nearest_[wave], {});
  std::exchange(contacts_[wave], {});
  for (const std::uint32_t number : std::exchange(places_[wave], {})) {
    if (labels_[number].wave() == wave) forget(number);
  }
}

void UnitWaves::look_again(Index h) {
  for (int unit = 0; unit < carrier_.units(); ++unit) {
    State in = carrier_.state(h, unit);
    for (int side = 0; side < 3; ++side, in = carrier_.along(in)) {
      const std::uint32_t number = carrier_.number(in);
      if (labels_[number].cost < never) {
        forget_beyond(number);
        queue_.push(labels_[number].cost, number);
      }
      const std::uint32_t seed = carrier_.number(carrier_.across(in));
      if (labels_[seed].cost < never && labels_[seed].origin() == nowhere) {
        forget_beyond(seed);
        forget(seed);
      } else if (wave_[UnitCarrier::triangle(in)] != no_index) {
        forgotten_.push_back(seed);  // it may now be cheaper to start there
      }
    }
  }
}

void UnitWaves::meet_again(const Meeting& meeting) {
  std::vector<Meeting>& nearest = nearest_[meeting.wave];
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
    std::vector<std::uint32_t> contacts = std::exchange(contacts_[wave], {});
    sort_unique(contacts);
    for (const std::uint32_t number : contacts) {
      const Label& label = labels_[number];
      if (label.cost < never && label.wave() == wave) meet(carrier_.state(number), meetings);
    }
  }
}

void UnitWaves::forget(std::uint32_t number) {
  if (labels_[number].cost == never) return;
  labels_[number].cost = never;
  forgotten_.push_back(number);
}

/// What has come by way of a state.
void UnitWaves::forget_beyond(std::uint32_t number) {
  std::vector<std::uint32_t> from{number};
  while (!from.empty()) {
    State out = carrier_.state(from.back());
    const std::uint32_t wave = labels_[from.back()].wave();
    from.pop_back();
    for (const Origin origin : {previous_edge, edge_before}) {
      out = carrier_.along(out);
      if (carrier_.halfedge(out) == no_index) break;  // outside there is one side
      const std::uint32_t next = carrier_.number(carrier_.across(out));
      const Label& label = labels_[next];
      if (label.cost == never || label.wave() != wave || label.origin() != origin) continue;
      forget(next);
      from.push_back(next);
    }
  }
}

/// By the waves that are beside it.
void UnitWaves::come_back_to(std::uint32_t number, std::vector<Visit>& visits) const {
  const State out = carrier_.across(carrier_.state(number));
  const std::uint32_t triangle = UnitCarrier::triangle(out);
  if (wave_[triangle] != no_index) step_from_start(out, visits);
  State in = out;
  for (std::size_t side = 0; side < 2; ++side) {
    in = carrier_.back(in);
    const Label& label = labels_[carrier_.number(in)];
    if (label.cost == never || wave_[triangle] == label.wave() || carrier_.gain(in)) continue;
    step(label.cost + carrier_.passing(in)[side], carrier_.across(out),
         side == 0 ? previous_edge : edge_before, label.wave(), visits);
  }
}

std::optional<UnitWaves::Ends> UnitWaves::ends(const Meeting& meeting) const {
  const Label& here = labels_[meeting.here];
  if (here.cost != meeting.here_cost) return std::nullopt;
  if (meeting.there == no_index) {
    const bool stands = meeting.cost == here.cost + carrier_.ending(carrier_.state(meeting.here));
    return stands ? std::optional<Ends>({starts_[here.wave()], no_index}) : std::nullopt;
  }
  const Label& there = labels_[meeting.there];
  if (there.cost != meeting.there_cost || there.wave() == here.wave()) return std::nullopt;
  return Ends{starts_[here.wave()], starts_[there.wave()]};
}

std::vector<UnitCarrier::State> UnitWaves::way(std::uint32_t number) const {
  std::vector<State> steps;
  for (const std::uint32_t wave = labels_[number].wave();;) {
    const Label& label = labels_[number];
    const State out = carrier_.across(carrier_.state(number));
    steps.push_back(out);
    if (label.origin() == nowhere) return steps;
    State in = carrier_.back(out);
    if (label.origin() == edge_before) in = carrier_.back(in);
    number = carrier_.number(in);
    if (labels_[number].wave() != wave || !(labels_[number].cost < label.cost)) return {};
  }
}

}  // namespace meshgrain
