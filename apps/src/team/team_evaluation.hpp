// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "helixnav/evaluation/evaluation.hpp"
#include "team/team_drive.hpp"

namespace helixnav::apps {

/// Errors of one robot at its sightings, as estimated then: raw in the frame of its component's first robot (or the common
/// one), and after a rigid alignment of the robot's own path.
struct RobotErrors {
  evaluation::ErrorStatistics raw_m;
  evaluation::ErrorStatistics aligned_m;
  double nees_mean =
      0.0;  ///< of (x, y, heading), since the robot has been in that frame; 3 if consistent, NaN if none counts
};

/// Landmarks of one component by their labels.
struct LandmarkErrors {
  int component = 0;
  std::size_t landmarks = 0;
  double raw_rmse_m = 0.0;      ///< NaN if the frame is unknown
  double aligned_rmse_m = 0.0;  ///< after a rigid alignment of the landmarks
};

struct TeamEvaluation {
  std::vector<std::optional<RobotErrors>> robots;  ///< nothing without truth
  std::vector<LandmarkErrors> landmarks;
};

/// T_component_truth: identity if starts are known, else from the true start of the component's first robot; nothing if
/// that has no truth.
std::optional<core::Pose2> frame_of_truth(const TeamTask& task, int component);

TeamEvaluation evaluate_team(const TeamTask& task, const TeamDrive& drive);

}  // namespace helixnav::apps
