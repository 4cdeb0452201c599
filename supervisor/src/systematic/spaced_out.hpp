// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "loop/tape.hpp"

namespace helixnav::supervisor {

/// Stops closer than `least_m` to the one before are passed over, and the motion to and from them is chained.
std::vector<Stop> spaced_out(const std::vector<Stop>& stops, double least_m);

}  // namespace helixnav::supervisor
