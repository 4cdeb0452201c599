// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/numerical_health.hpp"
#include "helixnav/core/observation.hpp"

namespace helixnav::localization {

/// An observation of a known point.
struct Sighting {
  core::LandmarkId landmark = core::no_landmark;
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
  const core::Observation* observation = nullptr;
};

struct PoseUpdate {
  core::PoseGaussian pose;
  double nis = 0.0;  ///< νᵀS⁻¹ν of all sightings together
  int dof = 0;
  core::NumericalHealth numerics = {};
};

/// Joint EKF update of a pose with sightings of known points: S = HPHᵀ + R, K = PHᵀS⁻¹, Joseph's form of the covariance.
/// Without sightings nothing changes. NumericalError with step and landmarks when S is not positive definite or the
/// correction is not finite. O(rows³).
PoseUpdate update_pose(const core::PoseGaussian& pose, const core::Pose2& T_robot_sensor,
                       const std::vector<Sighting>& sightings, std::int64_t step);

}  // namespace helixnav::localization
