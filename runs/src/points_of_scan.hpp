// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"

namespace helixnav::runs {

/// [observation] where it was seen, in the robot frame [m]; NaN if the sensor measures only a range or a bearing.
std::vector<Eigen::Vector2f> points_of_scan(const core::Scan& scan);

}  // namespace helixnav::runs
