// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "change/floating.hpp"
#include "change/take_in.hpp"
#include "helixnav/atlas/atlas.hpp"
#include "solve/settle.hpp"
#include "tree/take_out.hpp"

namespace helixnav::atlas {
namespace {

/// The share of a phase's landmarks that another has to hold to be on the same ground.
constexpr double most_of_them = 0.75;

bool was_condensed(const State& state, int phase) { return state.leaf(phase).host >= 0; }

struct Sharing {
  int phase = 0;
  int landmarks = 0;
};

/// Of a phase, those that are not forgotten: what was taken for a landmark in passing ties the phase to nothing.
std::vector<int> lasting_landmarks_of(const State& state, int phase) {
  std::vector<int> points = landmarks_of(state.leaf(phase));
  const auto is_forgotten = [&](int v) { return state.variable(v).name < 0; };
  points.erase(std::remove_if(points.begin(), points.end(), is_forgotten), points.end());
  return points;
}

/// Phases that hold most of the landmarks of one, by increasing number.
std::vector<Sharing> on_ground_of(const State& state, int phase) {
  const std::vector<int> points = lasting_landmarks_of(state, phase);
  std::vector<int> all;
  for (const int v : points) {
    for (const int other : *state.phases_of[State::index(v)]) {
      if (other != phase) all.push_back(other);
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<Sharing> sharing;
  for (std::size_t i = 0; i < all.size();) {
    const std::size_t begin = i;
    while (i < all.size() && all[i] == all[begin]) ++i;
    const Sharing one{all[begin], static_cast<int>(i - begin)};
    if (one.landmarks >= most_of_them * static_cast<double>(points.size())) sharing.push_back(one);
  }
  return sharing;
}

/// The earlier phase that holds most of its landmarks; −1: none holds enough of them.
int host_for(const State& state, int phase) {
  Sharing best{-1, 0};
  for (const Sharing& one : on_ground_of(state, phase)) {
    if (one.phase < phase && one.landmarks > best.landmarks) best = one;
  }
  return best.phase;
}

/// How often the vehicle came, given the phases on some ground: consecutive ones are one visit, up to ten. Those before and after a
/// phase also share most of its landmarks while the vehicle passes; where it stays or turns round and round, all do.
int visits(const std::vector<int>& ground) {
  constexpr int longest = 10;
  int count = 0;
  int length = 0;
  for (std::size_t i = 0; i < ground.size(); ++i) {
    const bool goes_on = i > 0 && ground[i] == ground[i - 1] + 1 && length < longest;
    length = goes_on ? length + 1 : 1;
    if (!goes_on) ++count;
  }
  return count;
}

bool has_fix(const State& state, int phase) {
  const std::vector<Part>& parts = state.leaf(phase).parts;
  return std::any_of(parts.begin(), parts.end(), [](const Part& part) { return part.fix != nullptr; });
}

/// A run that floats and holds nothing that is to stay.
bool can_be_dropped(const State& state, const Run& run, int end) {
  for (int phase = run.first; phase <= run.last; ++phase) {
    if (phase == 0 || phase >= end || state.leaf(phase).revisits >= 0 || has_fix(state, phase)) return false;
  }
  return true;
}

/// The phase and the runs that go with it.
std::vector<int> phases_that_go(int phase, const std::vector<Run>& floating) {
  std::vector<int> go{phase};
  for (const Run& run : floating) {
    for (int one = run.first; one <= run.last; ++one) go.push_back(one);
  }
  std::sort(go.begin(), go.end());
  return go;
}

/// No landmark is held by these alone.
bool leave_all_landmarks(const State& state, const std::vector<int>& phases) {
  const auto goes = [&](int phase) { return std::binary_search(phases.begin(), phases.end(), phase); };
  return std::all_of(phases.begin(), phases.end(), [&](int phase) {
    const std::vector<int> points = lasting_landmarks_of(state, phase);
    return std::none_of(points.begin(), points.end(), [&](int v) {
      const std::vector<int>& holders = *state.phases_of[State::index(v)];
      return std::all_of(holders.begin(), holders.end(), goes);
    });
  });
}

bool condense_phase(State& state, int phase, int end) {
  const int host = host_for(state, phase);
  if (host < 0) return false;
  const std::vector<Run> floating = floating_without(state, phase);
  if (!std::all_of(floating.begin(), floating.end(), [&](const Run& run) { return can_be_dropped(state, run, end); })) {
    return false;
  }
  const std::vector<int> going = phases_that_go(phase, floating);
  const bool is_host_going = std::binary_search(going.begin(), going.end(), host);
  if (is_host_going || !leave_all_landmarks(state, going) || !hold_each_other_without(state, phase)) return false;
  for (const int one : going) bring_ground_along(state, one);
  if (!take_in(state, host, phase)) return false;
  for (const int one : going) take_out(state, one, host);
  return true;
}

/// Condenses one of the phases on the ground of `phase`, if there are too many. `end`: only phases before it.
bool condense_ground(State& state, int phase, int end) {
  if (was_condensed(state, phase)) return false;
  std::vector<int> ground{phase};
  for (const Sharing& one : on_ground_of(state, phase)) ground.push_back(one.phase);
  std::sort(ground.begin(), ground.end());
  const int most = state.options.laps_kept + 1;
  if (visits(ground) <= most) return false;
  const auto fixes = std::count_if(ground.begin(), ground.end(), [&](int one) { return has_fix(state, one); });
  for (const int one : ground) {
    const bool stays =
        one == 0 || one >= end || state.leaf(one).revisits >= 0 || (has_fix(state, one) && fixes <= most);
    if (!stays && condense_phase(state, one, end)) return true;
  }
  return false;
}

}  // namespace

int Atlas::condense() {
  State state = *working_;
  finish_descent(state);
  int count = 0;
  const int end = static_cast<int>(settled_->phases.size()) - 2;
  for (; state.condensed < end; ++state.condensed) {
    while (condense_ground(state, state.condensed, end)) ++count;
  }
  *working_ = std::move(state);
  return count;
}

}  // namespace helixnav::atlas
