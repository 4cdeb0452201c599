// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/run.hpp"

#include <algorithm>

namespace helixnav::runs {

RunTruth truth_of(const core::Recording& recording) {
  RunTruth truth;
  truth.poses = recording.true_poses;
  truth.positions = recording.true_positions;
  if (!truth.positions.empty()) truth.antenna_robot_m = recording.antenna_robot_m;
  truth.landmarks = recording.true_landmarks;
  truth.labels = recording.labels;
  // As in a folder, where a step without observations has no row.
  while (!truth.labels.empty() && truth.labels.back().empty()) truth.labels.pop_back();
  return truth;
}

void add_smoothed(Run& run, SmoothedRun smoothed) {
  const std::size_t n = smoothed.alone ? std::min(run.steps.size(), smoothed.poses.size()) : 0;
  for (std::size_t i = 0; i < n; ++i) run.steps[i].pose.mean = smoothed.poses[i];
  run.smoothed = std::move(smoothed);
}

}  // namespace helixnav::runs
