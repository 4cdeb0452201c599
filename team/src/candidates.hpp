// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>

#include "helixnav/team/team_options.hpp"
#include "join_components.hpp"

namespace helixnav::team {

/// Where component `from` stands in `into` by landmarks that both call by the same name, two or more: generalised least
/// squares over both maps' covariances. Nothing while χ² objects.
std::optional<Candidate> by_names(std::size_t into, std::size_t from, const JoinOptions& options, const State& state);

/// By the last two sightings, one each way, of a robot of each.
std::optional<Candidate> by_sightings(std::size_t into, std::size_t from, core::Nanoseconds t_ns,
                                      const JoinOptions& options, const State& state);

/// By where the landmarks stand, without names (supervisor::join_sessions).
std::optional<Candidate> by_constellation(std::size_t into, std::size_t from, const JoinOptions& options,
                                          const State& state);

}  // namespace helixnav::team
