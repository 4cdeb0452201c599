// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/core/observation.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// An observation of range and bearing that was used for a landmark of the final map that lasted.
struct LastingMatch {
  std::size_t scan = 0;
  std::size_t landmark = 0;  ///< counts those of the map that lasted
  core::Pose2 T_robot_sensor;
  Eigen::Matrix2d R_lower;  ///< root of its covariance
  core::PredictedObservation predicted;
  Eigen::Vector2d residual;
};

/// All of a run, in order, with the final path where there is one. Outliers (one in 3 million) and what is nearer than 1 mm are left
/// out. Test: apps/range_offset_test.cpp, apps/sensors_apart_test.cpp.
std::vector<LastingMatch> lasting_matches(const core::Recording& recording, const runs::Run& run);

}  // namespace helixnav::apps
