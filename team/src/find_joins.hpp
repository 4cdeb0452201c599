// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <tuple>

#include "helixnav/team/team_options.hpp"
#include "state.hpp"

namespace helixnav::team {

/// What is not evidence: joins undone, by their kind and the two robots, and sightings that a wrong join rested on, by time, robot
/// and robot seen.
struct RefusedJoins {
  std::set<std::tuple<TeamJoin::By, int, int>> joins;
  std::set<SightingKey> sightings;
};

/// Searches all pairs of components for what places one in the other's frame, and joins those to which χ² of the joint
/// solution does not object. Components are solved when this is called.
void find_joins(core::Nanoseconds t_ns, const TeamOptions& options, const RefusedJoins& refused, State& state);

}  // namespace helixnav::team
