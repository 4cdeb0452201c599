// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "helixnav/team/team_options.hpp"
#include "join_components.hpp"

namespace helixnav::team {

/// Where component `from` is in `into`, from landmarks that both call by the same name, two or more: generalised least
/// squares over both maps' covariances. Nothing if χ² objects.
std::optional<Candidate> by_names(std::size_t into, std::size_t from, const JoinOptions& options, const State& state);

/// From two sightings, one each way, of a robot of each: the last two, then the last two before those, a few times; any may be
/// of a different robot from the one it was taken for. `refused`: are not evidence.
std::vector<Candidate> by_sightings(std::size_t into, std::size_t from, core::Nanoseconds t_ns,
                                    const JoinOptions& options, const std::set<SightingKey>& refused,
                                    const State& state);

/// From where the landmarks are, without names (supervisor::join_sessions).
std::optional<Candidate> by_constellation(std::size_t into, std::size_t from, const JoinOptions& options,
                                          const State& state);

}  // namespace helixnav::team
