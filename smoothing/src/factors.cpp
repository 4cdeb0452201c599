// SPDX-License-Identifier: BSD-3-Clause
#include "factors.hpp"

#include "helixnav/core/angle.hpp"

namespace helixnav::smoothing {

State state_of(const core::LandmarkGraph& graph) {
  State state;
  for (const auto& pose : graph.poses) state.poses.push_back(pose.T_world_robot);
  for (const auto& landmark : graph.landmarks) state.landmarks.push_back(landmark.point_m);
  return state;
}

void put_state(const State& state, core::LandmarkGraph& graph) {
  for (std::size_t i = 0; i < state.poses.size(); ++i) graph.poses[i].T_world_robot = state.poses[i];
  for (std::size_t i = 0; i < state.landmarks.size(); ++i) graph.landmarks[i].point_m = state.landmarks[i];
}

BinaryFactor<3, 3, 3> odometry_factor(const core::LandmarkGraph::PoseEdge& edge, const core::Pose2& T_world_from,
                                      const core::Pose2& T_world_to) {
  const Eigen::Matrix2d R_from_world = core::rotation(T_world_from.heading_rad).transpose();
  const Eigen::Vector2d step_from_m = R_from_world * (T_world_to.position_m() - T_world_from.position_m());
  BinaryFactor<3, 3, 3> factor;
  factor.e.head<2>() = step_from_m - edge.T_from_to.position_m();
  factor.e[2] = core::wrap_to_pi(T_world_to.heading_rad - T_world_from.heading_rad - edge.T_from_to.heading_rad);
  factor.J_a.setZero();
  factor.J_a.topLeftCorner<2, 2>() = -R_from_world;
  factor.J_a.col(2) << step_from_m.y(), -step_from_m.x(), -1.0;
  factor.J_b.setZero();
  factor.J_b.topLeftCorner<2, 2>() = R_from_world;
  factor.J_b(2, 2) = 1.0;
  return factor;
}

UnaryFactor<2, 3> fix_factor(const core::AbsoluteFix& fix, const core::Pose2& T_world_robot) {
  const Eigen::Vector2d arm_world_m = core::rotation(T_world_robot.heading_rad) * fix.antenna_robot_m;
  UnaryFactor<2, 3> factor;
  factor.e = T_world_robot.position_m() + arm_world_m - fix.position_world_m;
  factor.J_a.leftCols<2>().setIdentity();
  factor.J_a.col(2) << -arm_world_m.y(), arm_world_m.x();
  return factor;
}

UnaryFactor<3, 3> prior_factor(const PosePrior& prior, const core::Pose2& T_world_robot) {
  UnaryFactor<3, 3> factor;
  factor.e = T_world_robot.vector() - prior.T_world_robot.vector();
  factor.e[2] = core::wrap_to_pi(factor.e[2]);
  factor.J_a.setIdentity();
  return factor;
}

UnaryFactor<2, 2> prior_factor(const LandmarkPrior& prior, const Eigen::Vector2d& point_m) {
  return {point_m - prior.point_m, Eigen::Matrix2d::Identity()};
}

}  // namespace helixnav::smoothing
