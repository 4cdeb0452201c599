// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "helixnav/core/angle.hpp"

namespace helixnav::core {

/// A pose in the plane, or the rigid motion that takes coordinates of one frame into another.
/// Order everywhere (vectors, covariances, files): x [m], y [m], heading [rad]; heading counter-clockwise in (-π, π],
/// x forward, y left. A variable `T_a_b` is the pose of frame b in frame a: it maps coordinates of b into a.
/// Test: core/se2_test.cpp (group laws, Jacobians against central differences).
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;

  Pose2() = default;
  Pose2(double x, double y, double heading) : x_m(x), y_m(y), heading_rad(wrap_to_pi(heading)) {}
  explicit Pose2(const Eigen::Vector3d& v) : Pose2(v.x(), v.y(), v.z()) {}

  Eigen::Vector3d vector() const { return {x_m, y_m, heading_rad}; }
  Eigen::Vector2d position_m() const { return {x_m, y_m}; }
};

/// R(heading): rotates vectors of the robot frame into the world frame.
Eigen::Matrix2d rotation(double heading_rad);

/// T_a_c = T_a_b ∘ T_b_c.
Pose2 compose(const Pose2& T_a_b, const Pose2& T_b_c);

/// T_b_a from T_a_b.
Pose2 inverse(const Pose2& T_a_b);

/// T_a_b⁻¹ ∘ T_a_c = T_b_c.
Pose2 between(const Pose2& T_a_b, const Pose2& T_a_c);

/// Coordinates in frame a of a point given in frame b.
Eigen::Vector2d transform(const Pose2& T_a_b, const Eigen::Vector2d& point_b_m);

/// Derivatives of compose(T_a_b, T_b_c) by the coordinates (x, y, heading) of its first and second argument, 3×3 each.
struct ComposeJacobians {
  Eigen::Matrix3d J_first;
  Eigen::Matrix3d J_second;
};
ComposeJacobians compose_jacobians(const Pose2& T_a_b, const Pose2& T_b_c);

}  // namespace helixnav::core
