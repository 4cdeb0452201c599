// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "helixnav/association/associate.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/team/team_options.hpp"
#include "state.hpp"

namespace helixnav::team {

/// Which landmarks of its component, by whichever robot, a robot sees: optimal assignment by likelihood ratio, as Navigator
/// associates, from the joint covariance of the robot and the landmarks within reach.
association::Assignment associate_scan(std::size_t robot, const core::Scan& scan, const TeamOptions& options,
                                       const State& state);

}  // namespace helixnav::team
