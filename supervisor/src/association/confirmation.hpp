// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/observation.hpp"

namespace helixnav::supervisor {

/// A sighting of an old landmark that is the only one in its scan.
struct IsolatedHit {
  core::LandmarkId landmark = core::no_landmark;
  double path_m = 0.0;  ///< along the drive
  /// Where the detection is in the world, and its covariances: due to the detector, and to the pose it was seen from.
  Eigen::Vector2d point_world_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d seen_m2 = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d from_m2 = Eigen::Matrix2d::Zero();
};

/// `seen`: of two rows, by a sensor at T_robot_sensor.
IsolatedHit isolated_hit(core::LandmarkId landmark, double path_m, const core::Observation& seen,
                         const core::PoseGaussian& pose, const core::Pose2& T_robot_sensor);

/// Two-hit confirmation: an isolated match with an old landmark is accepted at the second hit, because clutter does not
/// appear twice in the same place. The gate of a vehicle that has drifted is no place: the hits have to agree with each other.
/// An error of the pose moves both alike, so that only the detector's noise and what the pose's covariance has
/// changed by in between come in.
/// Test: supervisor/association/revisit_ambiguity_test.cpp, isolated_match_test.cpp, campaigns in docs/adr/0009-integrity.md.
class Confirmation {
 public:
  /// True if the last hit was on the same landmark, at the same place, and at most `reach_m` earlier.
  bool confirms(const IsolatedHit& hit, double reach_m);

 private:
  std::optional<IsolatedHit> last_;
};

}  // namespace helixnav::supervisor
