// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "state.hpp"

namespace helixnav::team {

/// Solves the graph of one component from where it is, and restarts its filter at the solution. False, with no change
/// except a clone where each robot is, if least squares does not converge in so many iterations or breaks down.
bool solve(std::size_t component, State& state, int most_iterations = 200);

/// The observed position of the robot seen, in the frame of the observing robot.
struct SeenPosition {
  Eigen::Vector2d position_m;
  Eigen::Matrix2d covariance_m2;
};
SeenPosition seen_position(const core::Pose2& T_robot_sensor, const core::Observation& observation);

}  // namespace helixnav::team
