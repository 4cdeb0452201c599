// SPDX-License-Identifier: BSD-3-Clause
#include "truth_of_fused.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <vector>

#include "helixnav/core/interpolate.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {
namespace {

std::optional<core::Pose2> true_pose_at(const std::vector<core::TruePose>& poses, core::Nanoseconds t_ns) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), t_ns,
                                      [](const core::TruePose& pose, core::Nanoseconds t) { return pose.t_ns < t; });
  if (after == poses.end() || (after == poses.begin() && after->t_ns != t_ns)) return std::nullopt;
  if (after->t_ns == t_ns) return after->T_world_robot;
  const core::TruePose& before = *std::prev(after);
  const double share = core::seconds(t_ns - before.t_ns) / core::seconds(after->t_ns - before.t_ns);
  return core::interpolate(before.T_world_robot, after->T_world_robot, share);
}

/// Of the truth and of the fixes.
bool is_one_frame(const core::Recording& recording, double sigma_m) {
  constexpr double most_sigmas = 4.0;
  std::size_t compared = 0, near = 0;
  for (const core::TruePosition& fix : recording.true_positions) {
    const std::optional<core::Pose2> T_map_robot = true_pose_at(recording.true_poses, fix.t_ns);
    if (!T_map_robot) continue;
    const core::Pose2 T_truth_robot = core::compose(*recording.truth_frame.T_truth_map, *T_map_robot);
    const Eigen::Vector2d antenna_m = core::transform(T_truth_robot, recording.antenna_robot_m);
    const double most_m = most_sigmas * (fix.sigma_m > 0.0 ? fix.sigma_m : sigma_m);
    ++compared;
    near += (antenna_m - fix.position_m).norm() < most_m ? 1 : 0;
  }
  return compared > 0 && 2 * near >= compared;
}

}  // namespace

void put_truth_in_frame_of_fixes(core::Recording& recording, double sigma_m) {
  std::optional<core::Pose2> T_truth_map;
  if (recording.truth_frame.T_truth_map && is_one_frame(recording, sigma_m)) T_truth_map = core::Pose2();
  runs::move_truth(T_truth_map, recording.truth_frame, recording.true_poses, recording.true_landmarks);
}

}  // namespace helixnav::apps
