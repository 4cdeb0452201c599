// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "helixnav/core/events.hpp"

namespace helixnav::team {

/// An increment split in two, the first being `share` in (0, 1) of it at constant twist and ending at t_ns. chain() of
/// both is the increment, mean and covariance. Test: team/split_motion_test.cpp.
std::pair<core::Odometry, core::Odometry> split_motion(const core::Odometry& motion, double share,
                                                       core::Nanoseconds t_ns);

}  // namespace helixnav::team
