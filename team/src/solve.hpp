// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "state.hpp"

namespace helixnav::team {

/// Solves the graph of one component from where it is, and begins its filter anew at the solution. False, and no change but
/// a clone where each robot is, where least squares does not converge or breaks down.
bool solve(std::size_t component, State& state);

/// The observed position of the robot seen, in the frame of the robot that sees.
struct SeenPosition {
  Eigen::Vector2d position_m;
  Eigen::Matrix2d covariance_m2;
};
SeenPosition seen_position(const core::Pose2& T_robot_sensor, const core::Observation& observation);

}  // namespace helixnav::team
