// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "state.hpp"

namespace helixnav::team {

/// T_component_sensor from where robots of a component have seen landmarks, of each robot one every `spacing_m` of its way at
/// most. O(sightings of landmarks). Test: team/slip_test.cpp.
std::vector<core::Pose2> looked_from(std::size_t component, double spacing_m, const State& state);

}  // namespace helixnav::team
