// SPDX-License-Identifier: BSD-3-Clause
#include "looked_from.hpp"

#include <optional>

namespace helixnav::team {

std::vector<core::Pose2> looked_from(std::size_t component, double spacing_m, const State& state) {
  std::vector<core::Pose2> poses;
  std::vector<std::optional<Eigen::Vector2d>> last_m(state.robots.size());
  for (const LandmarkRow& row : state.landmark_rows) {
    const Robot& robot = state.robots[row.robot];
    if (robot.component != component) continue;
    const core::Pose2 pose = core::compose(robot.clones[row.clone].T_component_robot, row.T_clone_sensor);
    std::optional<Eigen::Vector2d>& last = last_m[row.robot];
    if (last && (pose.position_m() - *last).norm() < spacing_m) continue;
    last = pose.position_m();
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace helixnav::team
