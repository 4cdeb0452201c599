// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "helixnav/sim/scenario.hpp"

namespace helixnav::sim {

/// The stretches of the route, ascending, over which the vehicle is carried.
std::vector<Stretch> draw_carried(const CarryOptions& options, double drive_m, std::uint64_t seed);

}  // namespace helixnav::sim
