// SPDX-License-Identifier: BSD-3-Clause
#include "own_truth.hpp"

#include <algorithm>
#include <optional>
#include <variant>

#include "helixnav/core/odometry.hpp"

namespace helixnav::logs {
namespace {

/// Interpolated between the two poses around it, at most a second away.
std::optional<core::Pose2> pose_at(const std::vector<core::TruePose>& poses, core::Nanoseconds t_ns) {
  constexpr core::Nanoseconds near_ns = 1'000'000'000;
  const auto after = std::lower_bound(poses.begin(), poses.end(), t_ns,
                                      [](const core::TruePose& pose, core::Nanoseconds t) { return pose.t_ns < t; });
  if (after != poses.end() && after->t_ns == t_ns) return after->T_world_robot;
  if (after == poses.begin() || after == poses.end()) {
    const core::TruePose& end = after == poses.end() ? poses.back() : poses.front();
    if (std::abs(end.t_ns - t_ns) > near_ns) return std::nullopt;
    return end.T_world_robot;
  }
  const core::TruePose& before = *std::prev(after);
  const double share = core::seconds(t_ns - before.t_ns) / core::seconds(after->t_ns - before.t_ns);
  const Eigen::Vector3d way = core::between(before.T_world_robot, after->T_world_robot).vector();
  return core::compose(before.T_world_robot, core::Pose2(Eigen::Vector3d(share * way)));
}

/// From the start of the drive to its position at a given time, by odometry.
core::Pose2 driven_until(const std::vector<core::Event>& events, core::Nanoseconds start_ns, core::Nanoseconds t_ns) {
  core::Pose2 T_start_now;
  core::Nanoseconds now_ns = start_ns;
  for (const core::Event& event : events) {
    const auto* motion = std::get_if<core::Odometry>(&event);
    if (motion == nullptr) continue;
    const bool is_within = motion->t_ns <= t_ns || motion->t_ns <= now_ns;
    const double share = is_within ? 1.0 : core::seconds(t_ns - now_ns) / core::seconds(motion->t_ns - now_ns);
    const Eigen::Vector3d way = motion->T_before_after.vector();
    T_start_now = core::compose(T_start_now, core::Pose2(Eigen::Vector3d(share * way)));
    now_ns = motion->t_ns;
    if (now_ns >= t_ns) break;
  }
  return T_start_now;
}

/// Where the vehicle was before the first event. If truth begins later, by a second at most, odometry covers the motion
/// until then. Without truth at that time: where it was after the first increment, minus that increment.
std::optional<core::Pose2> start_of(const std::vector<core::TruePose>& poses, const Beginning& beginning,
                                    const std::vector<core::Event>& events) {
  const core::TruePose& first = poses.front();
  if (first.t_ns > beginning.t_ns && pose_at(poses, beginning.t_ns)) {
    const core::Pose2 T_start_first = driven_until(events, beginning.t_ns, first.t_ns);
    return core::compose(first.T_world_robot, core::inverse(T_start_first));
  }
  if (beginning.T_start_first.vector().isZero(0.0)) return pose_at(poses, beginning.t_ns);
  const core::Nanoseconds start_ns = beginning.t_ns - beginning.lasted_ns;
  const bool is_known = beginning.lasted_ns > 0 && poses.front().t_ns <= start_ns + beginning.lasted_ns / 2;
  if (is_known) return pose_at(poses, start_ns);
  const std::optional<core::Pose2> after = pose_at(poses, beginning.t_ns);
  if (!after) return std::nullopt;
  return core::compose(*after, core::inverse(beginning.T_start_first));
}

}  // namespace

void add_truth(const OwnLog& log, const Beginning& beginning, core::Recording& recording) {
  recording.true_landmarks = log.true_landmarks;
  recording.true_positions = log.true_positions;
  for (const OwnFix& fix : log.fixes) recording.true_positions.push_back({fix.t_ns, fix.position_m, fix.sigma_m});
  if (!log.fixes.empty() && !log.true_positions.empty()) {
    recording.true_positions.erase(
        recording.true_positions.begin(),
        recording.true_positions.begin() + static_cast<std::ptrdiff_t>(log.true_positions.size()));
    recording.remarks.emplace_back("truth_poses: without headings, and there are fixes: the fixes are compared with");
  }
  if (log.true_poses.empty()) return;
  const std::optional<core::Pose2> start = start_of(log.true_poses, beginning, recording.events);
  if (!start) {
    recording.remarks.emplace_back(
        "truth_poses: none within a second of the first event, so that the frames are aligned by positions");
    for (const core::TruePose& pose : log.true_poses) {
      recording.true_positions.push_back({pose.t_ns, pose.T_world_robot.position_m()});
    }
    recording.antenna_robot_m.setZero();
    return;
  }
  recording.truth_frame.T_truth_map = *start;
  const core::Pose2 T_map_truth = core::inverse(*start);
  for (const core::TruePose& pose : log.true_poses) {
    recording.true_poses.push_back({pose.t_ns, core::compose(T_map_truth, pose.T_world_robot)});
  }
  for (core::TrueLandmark& landmark : recording.true_landmarks) {
    landmark.point_m = core::transform(T_map_truth, landmark.point_m);
  }
}

}  // namespace helixnav::logs
