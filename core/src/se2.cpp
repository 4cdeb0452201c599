// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/se2.hpp"

#include <cmath>

namespace helixnav::core {

Eigen::Matrix2d rotation(double heading_rad) {
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  Eigen::Matrix2d R;
  R << c, -s, s, c;
  return R;
}

Pose2 compose(const Pose2& T_a_b, const Pose2& T_b_c) {
  const Eigen::Vector2d position_a_m = transform(T_a_b, T_b_c.position_m());
  return {position_a_m.x(), position_a_m.y(), T_a_b.heading_rad + T_b_c.heading_rad};
}

Pose2 inverse(const Pose2& T_a_b) {
  const Eigen::Vector2d position_b_m = -(rotation(T_a_b.heading_rad).transpose() * T_a_b.position_m());
  return {position_b_m.x(), position_b_m.y(), -T_a_b.heading_rad};
}

Pose2 between(const Pose2& T_a_b, const Pose2& T_a_c) { return compose(inverse(T_a_b), T_a_c); }

Eigen::Vector2d transform(const Pose2& T_a_b, const Eigen::Vector2d& point_b_m) {
  return T_a_b.position_m() + rotation(T_a_b.heading_rad) * point_b_m;
}

ComposeJacobians compose_jacobians(const Pose2& T_a_b, const Pose2& T_b_c) {
  const Eigen::Matrix2d R = rotation(T_a_b.heading_rad);
  const Eigen::Vector2d step_a_m = R * T_b_c.position_m();
  ComposeJacobians J{Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()};
  J.J_first(0, 2) = -step_a_m.y();
  J.J_first(1, 2) = step_a_m.x();
  J.J_second.topLeftCorner<2, 2>() = R;
  return J;
}

}  // namespace helixnav::core
