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
/// `filter`: of the component, or as it would be after something; `slot`: the robot's in it.
association::Assignment associate_scan(std::size_t slot, const core::Scan& scan, const TeamOptions& options,
                                       const JointFilter& filter, const State& state);

/// The scan with the field of view that has shown landmarks so far if it does not say its own.
core::Scan with_view(const core::Scan& scan, const State& state);

}  // namespace helixnav::team
