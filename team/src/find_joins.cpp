// SPDX-License-Identifier: BSD-3-Clause
#include "find_joins.hpp"

#include <algorithm>

#include "candidates.hpp"

namespace helixnav::team {
namespace {

/// A constellation is asked for again when the two maps rest on twice as many observations as at the last question: so
/// there are few questions, and each may be answered falsely with its α.
bool has_grown(std::size_t into, std::size_t from, State& state) {
  int observations = 0;
  for (const std::size_t component : {into, from}) {
    for (const core::LandmarkId id : state.components[component].filter.ids()) {
      observations += state.observations[static_cast<std::size_t>(id)];
    }
  }
  int& asked = state.observations_asked[{into, from}];
  if (observations < 2 * asked || observations == 0) return false;
  asked = observations;
  return true;
}

bool join_pair(std::size_t into, std::size_t from, core::Nanoseconds t_ns, const TeamOptions& options,
               const RefusedJoins& refused, State& state) {
  const auto may = [&](TeamJoin::By by) {
    return refused.joins.count({by, static_cast<int>(state.components[into].robots.front()),
                                static_cast<int>(state.components[from].robots.front())}) == 0;
  };
  const auto join = [&](const std::optional<Candidate>& candidate) {
    return candidate && join_components(*candidate, t_ns, options, state);
  };
  using By = TeamJoin::By;
  const JoinOptions& by = options.join;
  if (by.by_sightings && may(By::sightings)) {
    for (const Candidate& candidate : by_sightings(into, from, t_ns, by, refused.sightings, state)) {
      if (join_components(candidate, t_ns, options, state)) return true;
    }
  }
  if (by.by_names && may(By::names) && join(by_names(into, from, by, state))) return true;
  return by.by_constellation && may(By::constellation) && has_grown(into, from, state) &&
         join(by_constellation(into, from, by, state));
}

bool has_start(const Component& component, const State& state) {
  return std::any_of(component.robots.begin(), component.robots.end(),
                     [&](std::size_t r) { return state.robots[r].start.has_value(); });
}

bool join_any(core::Nanoseconds t_ns, const TeamOptions& options, const RefusedJoins& refused, State& state) {
  for (std::size_t a = 0; a < state.components.size(); ++a) {
    for (std::size_t b = a + 1; b < state.components.size(); ++b) {
      if (state.components[a].robots.empty() || state.components[b].robots.empty()) continue;
      const bool keeps_b = has_start(state.components[b], state);  // the common frame stays
      if (join_pair(keeps_b ? b : a, keeps_b ? a : b, t_ns, options, refused, state)) return true;
    }
  }
  return false;
}

}  // namespace

const char* name_of(TeamJoin::By by) {
  switch (by) {
    case TeamJoin::By::names:
      return "names";
    case TeamJoin::By::sightings:
      return "sightings";
    default:
      return "constellation";
  }
}

void find_joins(core::Nanoseconds t_ns, const TeamOptions& options, const RefusedJoins& refused, State& state) {
  while (join_any(t_ns, options, refused, state)) {
  }
}

}  // namespace helixnav::team
