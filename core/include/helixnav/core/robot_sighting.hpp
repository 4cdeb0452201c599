// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/observation.hpp"
#include "helixnav/core/se2.hpp"
#include "helixnav/core/time.hpp"

namespace helixnav::core {

/// One robot of a team sees the reference point of another.
struct RobotSighting {
  Nanoseconds t_ns = 0;
  int seen = 0;  ///< index of the robot seen, in the team
  Pose2 T_robot_sensor;
  Observation observation;  ///< kinds with two rows
};

}  // namespace helixnav::core
