// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/run.hpp"

#include <algorithm>

#include "bring_into_map.hpp"

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

void correct_path(Run& run, const std::vector<core::StampedPose>& solved) {
  if (solved.empty()) {
    if (step_of_placing(run)) run.final_path = poses_of(run);
    return;
  }
  const core::Pose2 T_map_told = frame_at(run, solved.back().t_ns).value_or(core::Pose2{});
  run.final_path.clear();
  run.final_path.reserve(run.steps.size());
  auto next = solved.begin();
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    const core::StepReport& step = run.steps[k];
    while (next != solved.end() && next->t_ns < step.t_ns) ++next;
    if (next == solved.end()) {
      run.final_path.push_back(step.pose.mean);
    } else if (next->t_ns == step.t_ns || k == 0) {
      run.final_path.push_back(core::compose(T_map_told, next->T_world_robot));
    } else {
      const core::Pose2 motion = core::between(run.steps[k - 1].pose.mean, step.pose.mean);
      run.final_path.push_back(core::compose(run.final_path.back(), motion));
    }
  }
}

void add_smoothed(Run& run, SmoothedRun smoothed) {
  const std::size_t n = smoothed.alone ? std::min(run.steps.size(), smoothed.poses.size()) : 0;
  for (std::size_t i = 0; i < n; ++i) run.steps[i].pose.mean = smoothed.poses[i];
  run.final_path = smoothed.poses;
  run.smoothed = std::move(smoothed);
}

}  // namespace helixnav::runs
