// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>

#include "find_joins.hpp"

namespace helixnav::team {

struct WrongJoin {
  std::size_t join = 0;
  int refused = 0;  ///< sightings between its two sides
  int seen = 0;
};

/// The last join that later sightings contradict: of the first forty of a robot on one side by one on the other, six and more
/// than half are refused. One misread robot is enough for two sightings that agree. A refused sighting that fits another robot
/// of the team, as one that was taken for the wrong robot does, says nothing of the join. Test: team/team_test.cpp.
std::optional<WrongJoin> find_wrong_join(const State& state);

/// It is not made again on the same evidence: if that is two sightings, on either of them.
void refuse(std::size_t join, const State& state, RefusedJoins& refused);

}  // namespace helixnav::team
