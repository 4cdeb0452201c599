// SPDX-License-Identifier: BSD-3-Clause
#include "change/floating.hpp"

#include <algorithm>

namespace helixnav::atlas {
namespace {

/// The phases that are left when one of them is condensed, too.
class Left {
 public:
  Left(const State& state, int phase) : state_(state), phase_(phase) {}

  bool has(int phase) const {
    const bool is_there = phase >= 0 && phase < static_cast<int>(state_.phases.size());
    return is_there && phase != phase_ && state_.leaf(phase).host < 0;
  }

  Run run_of(int phase) const {
    Run run{phase, phase};
    while (has(run.first - 1)) --run.first;
    while (has(run.last + 1)) ++run.last;
    return run;
  }

  /// Whether the run shares two landmarks with others.
  bool is_held(const Run& run) const {
    std::vector<int> shared;
    for (int phase = run.first; phase <= run.last; ++phase) {
      for (const int v : landmarks_of(state_.leaf(phase))) {
        if (is_shared(v, run)) shared.push_back(v);
        if (shared.size() > 1 && shared.back() != shared.front()) return true;
      }
    }
    return false;
  }

 private:
  bool is_shared(int variable, const Run& run) const {
    const std::vector<int>& phases = *state_.phases_of[State::index(variable)];
    return std::any_of(phases.begin(), phases.end(),
                       [&](int other) { return other != phase_ && (other < run.first || other > run.last); });
  }

  const State& state_;
  int phase_;
};

/// Phases connected to `phase`: by a pose, or by a landmark.
std::vector<int> beside(const State& state, int phase) {
  std::vector<int> others{phase - 1, phase + 1};
  for (const int v : landmarks_of(state.leaf(phase))) {
    const std::vector<int>& phases = *state.phases_of[State::index(v)];
    others.insert(others.end(), phases.begin(), phases.end());
  }
  std::sort(others.begin(), others.end());
  return others;
}

}  // namespace

std::vector<Run> floating_without(const State& state, int phase) {
  const Left left(state, phase);
  std::vector<Run> floating;
  int looked_at = -1;  // the last phase of a run that was looked at
  for (const int other : beside(state, phase)) {
    if (other <= looked_at || !left.has(other)) continue;
    const Run run = left.run_of(other);
    looked_at = run.last;
    if (!left.is_held(run)) floating.push_back(run);
  }
  return floating;
}

}  // namespace helixnav::atlas
