// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/run.hpp"

#include <algorithm>

#include "as_kept.hpp"
#include "bring_into_map.hpp"

namespace helixnav::runs {

RunTruth truth_of(const core::Recording& recording) {
  RunTruth truth;
  truth.poses = recording.true_poses;
  truth.frame = recording.truth_frame;
  truth.frame_when_placed = recording.truth_frame_when_placed;
  truth.positions = recording.true_positions;
  if (!truth.positions.empty()) truth.antenna_robot_m = recording.antenna_robot_m;
  truth.landmarks = recording.true_landmarks;
  truth.labels = recording.labels;
  // As in a folder, where a step without observations has no row.
  while (!truth.labels.empty() && truth.labels.back().empty()) truth.labels.pop_back();
  return truth;
}

namespace {

/// Steps between two solved poses, and after the last one, follow by the motion between their estimates.
void follow(Run& run, const std::vector<core::StampedPose>& solved) {
  const std::vector<FrameOfStep> frames = frames_of(run);
  const auto frame_at = [&](core::Nanoseconds t_ns) {
    const auto later = [](const core::StepReport& step, core::Nanoseconds at_ns) { return step.t_ns < at_ns; };
    const auto step = std::lower_bound(run.steps.begin(), run.steps.end(), t_ns, later);
    if (step == run.steps.end()) return FrameOfStep{frames.back().times_carried, 0, 0, {}, {}};
    return frames[static_cast<std::size_t>(step - run.steps.begin())];
  };
  run.final_path.clear();
  run.final_path.reserve(run.steps.size());
  auto next = solved.begin();
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    const core::StepReport& step = run.steps[k];
    while (next != solved.end() && next->t_ns < step.t_ns) ++next;
    const FrameOfStep frame = next == solved.end() ? FrameOfStep{} : frame_at(next->t_ns);
    const bool begins = k == 0 || frames[k].times_carried != frames[k - 1].times_carried;
    if (next == solved.end() || frame.times_carried != frames[k].times_carried) {
      run.final_path.push_back(step.pose.mean);
    } else if (next->t_ns == step.t_ns || begins) {
      run.final_path.push_back(core::compose(frame.T_final_solved, next->T_world_robot));
    } else {
      const core::Pose2 motion = core::between(run.steps[k - 1].pose.mean, step.pose.mean);
      run.final_path.push_back(core::compose(run.final_path.back(), motion));
    }
  }
}

}  // namespace

void correct_path(Run& run, const std::vector<core::StampedPose>& solved) {
  if (!solved.empty()) {
    follow(run, solved);
  } else if (has_found_place(run)) {
    run.final_path = poses_of(run);
  }
  for (core::Pose2& pose : run.final_path) pose = as_kept(pose);
}

void add_smoothed(Run& run, SmoothedRun smoothed) {
  const std::size_t n = smoothed.alone ? std::min(run.steps.size(), smoothed.poses.size()) : 0;
  for (std::size_t i = 0; i < n; ++i) run.steps[i].pose.mean = smoothed.poses[i];
  run.final_path = smoothed.poses;
  run.smoothed = std::move(smoothed);
}

}  // namespace helixnav::runs
