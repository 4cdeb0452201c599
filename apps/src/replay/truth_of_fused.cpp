// SPDX-License-Identifier: BSD-3-Clause
#include "truth_of_fused.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <vector>

#include "helixnav/core/interpolate.hpp"
#include "helixnav/core/rigid_fit.hpp"
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

/// Where the antenna truly was at each fix, and the fixes.
struct Compared {
  std::vector<Eigen::Vector2d> true_m, fixes_m;
  std::size_t near = 0;  ///< within four standard deviations
};

Compared compared_with_truth(const core::Recording& recording, double sigma_m) {
  constexpr double most_sigmas = 4.0;
  Compared all;
  for (const core::TruePosition& fix : recording.true_positions) {
    const std::optional<core::Pose2> T_map_robot = true_pose_at(recording.true_poses, fix.t_ns);
    if (!T_map_robot) continue;
    const core::Pose2 T_truth_robot = core::compose(*recording.truth_frame.T_truth_map, *T_map_robot);
    all.true_m.push_back(core::transform(T_truth_robot, recording.antenna_robot_m));
    all.fixes_m.push_back(fix.position_m);
    const double most_m = most_sigmas * (fix.sigma_m > 0.0 ? fix.sigma_m : sigma_m);
    all.near += (all.true_m.back() - fix.position_m).norm() < most_m ? 1 : 0;
  }
  return all;
}

double median_distance_m(const Compared& all, const core::Pose2& T_fixes_truth) {
  std::vector<double> distances_m;
  for (std::size_t i = 0; i < all.true_m.size(); ++i)
    distances_m.push_back((core::transform(T_fixes_truth, all.true_m[i]) - all.fixes_m[i]).norm());
  const auto middle = distances_m.begin() + static_cast<std::ptrdiff_t>(distances_m.size() / 2);
  std::nth_element(distances_m.begin(), middle, distances_m.end());
  return *middle;
}

/// Of the truth and of the fixes: these are near, or err in a way that another frame hardly explains, as with an antenna or a
/// clock that is wrong.
bool is_one_frame(const core::Recording& recording, double sigma_m) {
  constexpr double explained = 3.0;
  const Compared all = compared_with_truth(recording, sigma_m);
  if (all.true_m.size() < 2) return all.near > 0;
  if (2 * all.near >= all.true_m.size()) return true;
  const core::Pose2 T_fixes_truth = core::fit_rigidly(all.fixes_m, all.true_m);
  return median_distance_m(all, core::Pose2()) < explained * median_distance_m(all, T_fixes_truth);
}

}  // namespace

void put_truth_in_frame_of_fixes(core::Recording& recording, double sigma_m) {
  std::optional<core::Pose2> T_truth_map;
  if (recording.truth_frame.T_truth_map && is_one_frame(recording, sigma_m)) T_truth_map = core::Pose2();
  runs::move_truth(T_truth_map, recording.truth_frame, recording.true_poses, recording.true_landmarks);
}

}  // namespace helixnav::apps
