// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "helixnav/core/events.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::core {

/// The pose a fraction of the way from one to another along the arc of constant twist. Test: core/interpolate_test.cpp.
Pose2 interpolate(const Pose2& T_world_a, const Pose2& T_world_b, double fraction);

/// An increment split into two, the first of which ends at t_ns, a fraction of the way along its arc: noise grows
/// evenly along it. chain() of the two is the increment, except for what the first one's heading adds to the second
/// one's position. Test: core/interpolate_test.cpp.
std::pair<Odometry, Odometry> split(const Odometry& whole, double fraction, Nanoseconds t_ns);

}  // namespace helixnav::core
