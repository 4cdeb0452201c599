// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "helixnav/core/se2.hpp"

namespace helixnav::runs {

/// A pose with the heading that is read back from the quaternion about z by which it is stored.
inline core::Pose2 as_kept(const core::Pose2& pose) {
  const double half_rad = 0.5 * pose.heading_rad;
  return core::Pose2(pose.x_m, pose.y_m, 2.0 * std::atan2(std::sin(half_rad), std::cos(half_rad)));
}

}  // namespace helixnav::runs
