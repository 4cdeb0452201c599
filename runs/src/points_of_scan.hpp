// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"

namespace helixnav::runs {

/// [observation] where it was seen, in the robot's frame [m]; NaN where the sensor tells a range or a bearing alone.
std::vector<Eigen::Vector2f> points_of_scan(const core::Scan& scan);

}  // namespace helixnav::runs
