// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/observation.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::atlas {

/// An observation whose landmark is known by name.
struct SeenLandmark {
  core::LandmarkId id = core::no_landmark;
  core::Pose2 T_robot_sensor;
  core::Observation observation;
};

/// Motion to the next pose, with covariance in (x, y, heading) of the frame before it [m, m, rad], and what was seen there.
/// Increments between two scans are chained (core::chain). A covariance of rank two has to be softened beforehand.
struct LoggedStep {
  core::Pose2 T_before_after;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  std::vector<SeenLandmark> seen;
};

/// A stretch of the drive as measured: what goes into the map, and from which it can be relinearised.
/// What was seen at the pose where it begins belongs to the phase before; only the first phase of a drive has `seen_at_entry`.
/// A fix ends a phase (Atlas::fix).
struct PhaseLog {
  std::vector<SeenLandmark> seen_at_entry;
  std::vector<LoggedStep> steps;  ///< at least one
};

/// Names of the landmarks in a log, increasing, each once.
std::vector<core::LandmarkId> landmarks_of(const PhaseLog& log);

/// PreconditionError, naming the step or the landmark, unless there is a step, every covariance is symmetric positive
/// definite, every observation passes core::check_observation and no name is negative. Test: atlas/phase_factor_test.cpp.
void check_log(const PhaseLog& log);

}  // namespace helixnav::atlas
