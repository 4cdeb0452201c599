// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/observation.hpp"

namespace helixnav::core {

/// EKF over a pose alone, among points whose positions are taken as exact. Map frame, covariance in (x, y, heading)
/// [m, m, rad]. Every call succeeds or throws NumericalError (a result that is not finite) and leaves the pose as it was.
/// No allocation unless it throws. Source: THEORY §1 with a map without uncertainty. Test: core/pose_on_map_test.cpp.
class PoseOnMap {
 public:
  explicit PoseOnMap(const PoseGaussian& start) : pose_(start) {}

  /// P becomes J₁PJ₁ᵀ + J₂QJ₂ᵀ with core::compose_jacobians.
  void move(const Odometry& odometry);
  /// Update with one observation of a point: K = PHᵀS⁻¹, P becomes P − KHP.
  void see(const Observation& observation, const Pose2& T_robot_sensor, const Eigen::Vector2d& point_m);

  const Pose2& mean() const { return pose_.mean; }
  const PoseGaussian& estimate() const { return pose_; }

 private:
  void become(const PoseGaussian& pose, const char* verb);

  PoseGaussian pose_;
};

}  // namespace helixnav::core
