// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "helixnav/core/recording.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// How two sensors of a vehicle contradict each other, whose landmarks are one map and whose scans one path: by how much the one
/// sees them farther away, or farther to the left, than the other.
struct SensorsApart {
  core::Pose2 T_robot_one, T_robot_other;  ///< mountings, by which a recording tells sensors apart
  double farther_m = 0.0;
  double farther_sigma_m = 0.0;
  double left_rad = 0.0;
  double left_sigma_rad = 0.0;
};

/// The pair of sensors that contradicts itself most surely: means of residuals of range and bearing over stretches of the drive in
/// which both matched landmarks that lasted, one sensor less the other. What is wrong with pose and map then is the same for both. Its
/// scatter from one stretch to the next is what the mean is judged by. A delay of one sensor shows as ranges, which are too long ahead
/// or behind. Empty for a single sensor, or with fewer than eight such stretches. Cost: a pass over the associations, after
/// the run. Test: apps/sensors_apart_test.cpp.
std::optional<SensorsApart> sensors_apart_of(const core::Recording& recording, const runs::Run& run);

bool surely_apart(const SensorsApart& apart);

}  // namespace helixnav::apps
