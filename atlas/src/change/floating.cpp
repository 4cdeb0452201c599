// SPDX-License-Identifier: BSD-3-Clause
#include "change/floating.hpp"

#include <algorithm>

#include "helixnav/core/angle.hpp"

namespace helixnav::atlas {
namespace {

/// Between two drives: it turns by an angle that nobody measured, and sees nothing.
bool is_gap(const Leaf& leaf) {
  const RelativeGaussian& motion = leaf.phase->gaussian;
  return motion.mean.size() == 3 && motion.information.full()(2, 2) * core::pi * core::pi < 1.0;
}

/// The phases that are left when one of them is condensed, too.
class Left {
 public:
  Left(const State& state, int phase) : state_(state), phase_(phase) {}

  bool has(int phase) const {
    const bool is_there = phase >= 0 && phase < static_cast<int>(state_.phases.size());
    return is_there && phase != phase_ && state_.leaf(phase).host < 0 && !is_gap(state_.leaf(phase));
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

/// Runs that hold each other, and the landmarks that they share with others.
class Body {
 public:
  explicit Body(const Run& run) { take(run); }

  void take(const Run& run) {
    runs_.push_back(run);
    for (int phase = run.first; phase <= run.last; ++phase) phases_.push_back(phase);
  }
  void take(const Body& other) {
    for (const Run& run : other.runs_) take(run);
  }
  bool has(int phase) const {
    return std::any_of(runs_.begin(), runs_.end(),
                       [&](const Run& run) { return phase >= run.first && phase <= run.last; });
  }
  const std::vector<int>& phases() const { return phases_; }

 private:
  std::vector<Run> runs_;
  std::vector<int> phases_;
};

/// A landmark that a phase outside a body has, too.
struct Tie {
  int landmark;
  int phase;
};

std::vector<Tie> ties_of(const State& state, const Left& left, const Body& body, int phase) {
  std::vector<Tie> ties;
  for (const int v : landmarks_of(state.leaf(phase))) {
    for (const int other : *state.phases_of[State::index(v)]) {
      if (left.has(other) && !body.has(other)) ties.push_back({v, other});
    }
  }
  return ties;
}

/// Of the landmarks that two share. `first`: the one before; −1: none yet.
bool is_second(int& first, int landmark) {
  if (first >= 0 && first != landmark) return true;
  first = landmark;
  return false;
}

struct RunAround {
  Run run;
  int first_landmark = -1;
  bool has(int phase) const { return phase >= run.first && phase <= run.last; }
};

/// The body that holds this one, which takes in other runs on the way there; −1: none does.
int body_that_holds(const State& state, const Left& left, std::vector<Body>& bodies, std::size_t one) {
  constexpr std::size_t most_phases = 2000;
  std::vector<int> first_with(bodies.size(), -1);
  std::vector<RunAround> around;
  for (std::size_t i = 0; i < bodies[one].phases().size() && i < most_phases; ++i) {
    for (const Tie& tie : ties_of(state, left, bodies[one], bodies[one].phases()[i])) {
      const auto has_it = [&](const auto& some) { return some.has(tie.phase); };
      const auto body = std::find_if(bodies.begin(), bodies.end(), has_it);
      if (body != bodies.end()) {
        const auto k = static_cast<std::size_t>(body - bodies.begin());
        if (k != one && is_second(first_with[k], tie.landmark)) return static_cast<int>(k);
        continue;
      }
      auto run = std::find_if(around.begin(), around.end(), has_it);
      if (run == around.end()) run = around.insert(run, RunAround{left.run_of(tie.phase)});
      if (!is_second(run->first_landmark, tie.landmark)) continue;
      bodies[one].take(run->run);
      around.erase(run);
    }
  }
  return -1;
}

}  // namespace

bool hold_each_other_without(const State& state, int phase) {
  const Left left(state, phase);
  std::vector<Body> bodies;
  for (const int other : beside(state, phase)) {
    const auto is_known = [&](const Body& body) { return body.has(other); };
    if (!left.has(other) || std::any_of(bodies.begin(), bodies.end(), is_known)) continue;
    const Run run = left.run_of(other);
    if (left.is_held(run)) bodies.emplace_back(run);
  }
  while (bodies.size() > 1) {
    const auto least = std::min_element(bodies.begin(), bodies.end(), [](const Body& a, const Body& b) {
      return a.phases().size() < b.phases().size();
    });
    const auto one = static_cast<std::size_t>(least - bodies.begin());
    const int by = body_that_holds(state, left, bodies, one);
    if (by < 0) return false;
    bodies[static_cast<std::size_t>(by)].take(bodies[one]);
    bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(one));
  }
  return true;
}

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
