// SPDX-License-Identifier: BSD-3-Clause
#include "split_motion.hpp"

#include <cmath>

#include <Eigen/LU>

namespace helixnav::team {
namespace {

/// What a twist of this turn does to its velocity: V of the exponential map of SE(2).
Eigen::Matrix2d arc(double turn_rad) {
  const bool straight = std::abs(turn_rad) < 1e-9;
  const double along = straight ? 1.0 : std::sin(turn_rad) / turn_rad;
  const double across = straight ? 0.5 * turn_rad : (1.0 - std::cos(turn_rad)) / turn_rad;
  return (Eigen::Matrix2d() << along, -across, across, along).finished();
}

core::Pose2 part_of(const core::Pose2& T, double share) {
  const double turn_rad = T.heading_rad;
  const Eigen::Vector2d way_m = arc(share * turn_rad) * arc(turn_rad).inverse() * (share * T.position_m());
  return {way_m.x(), way_m.y(), share * turn_rad};
}

Eigen::Matrix3d pulled_back(const Eigen::Matrix3d& covariance, const Eigen::Matrix3d& J, double share) {
  const Eigen::Matrix3d J_inverse = J.inverse();
  const Eigen::Matrix3d P = share * J_inverse * covariance * J_inverse.transpose();
  return 0.5 * (P + P.transpose());
}

}  // namespace

std::pair<core::Odometry, core::Odometry> split_motion(const core::Odometry& motion, double share,
                                                       core::Nanoseconds t_ns) {
  core::Odometry first, second;
  first.t_ns = t_ns;
  first.T_before_after = part_of(motion.T_before_after, share);
  second.t_ns = motion.t_ns;
  second.T_before_after = core::between(first.T_before_after, motion.T_before_after);
  const core::ComposeJacobians J = core::compose_jacobians(first.T_before_after, second.T_before_after);
  first.covariance = pulled_back(motion.covariance, J.J_first, share);
  second.covariance = pulled_back(motion.covariance, J.J_second, 1.0 - share);
  return {first, second};
}

}  // namespace helixnav::team
