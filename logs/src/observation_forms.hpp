// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "helixnav/core/observation.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::logs {

/// A landmark as a point in the robot frame, for file formats that have no other form.
struct PointInRobotFrame {
  Eigen::Vector2d point_m;
  Eigen::Matrix2d covariance_m2;
};

/// Exact for Cartesian observations; range and bearing to first order. PreconditionError for bearings or ranges alone.
inline PointInRobotFrame in_robot_frame(const core::Observation& observation, const core::Pose2& T_robot_sensor) {
  const core::LocatedLandmark located = core::locate_landmark(observation, core::Pose2(), T_robot_sensor);
  const Eigen::Matrix2d C = located.G_z * Eigen::Matrix2d(observation.R) * located.G_z.transpose();
  return {located.point_world_m, 0.5 * (C + C.transpose())};
}

}  // namespace helixnav::logs
