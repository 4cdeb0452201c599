// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/interpolate.hpp"

#include <cmath>

#include <Eigen/LU>

namespace helixnav::core {

namespace {

// Maps the translation of a unit twist with rotation `angle` to its chord: [[s, -c], [c, s]] with s = sin a / a and
// c = (1 - cos a) / a.
Eigen::Matrix2d chord_of_twist(double angle_rad) {
  const bool small = std::abs(angle_rad) < 1e-6;
  const double s = small ? 1.0 - angle_rad * angle_rad / 6.0 : std::sin(angle_rad) / angle_rad;
  const double c = small ? 0.5 * angle_rad : (1.0 - std::cos(angle_rad)) / angle_rad;
  return (Eigen::Matrix2d() << s, -c, c, s).finished();
}

}  // namespace

Pose2 interpolate(const Pose2& T_world_a, const Pose2& T_world_b, double fraction) {
  const Pose2 T_a_b = between(T_world_a, T_world_b);
  const double angle = T_a_b.heading_rad;
  const Eigen::Vector2d twist = chord_of_twist(angle).inverse() * T_a_b.position_m();
  const Eigen::Vector2d chord = chord_of_twist(fraction * angle) * (fraction * twist);
  return compose(T_world_a, Pose2(chord.x(), chord.y(), fraction * angle));
}

std::pair<Odometry, Odometry> split(const Odometry& whole, double fraction, Nanoseconds t_ns) {
  Odometry first, second;
  first.t_ns = t_ns;
  first.T_before_after = interpolate({}, whole.T_before_after, fraction);
  first.covariance = fraction * whole.covariance;
  second.t_ns = whole.t_ns;
  second.T_before_after = between(first.T_before_after, whole.T_before_after);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = rotation(-first.T_before_after.heading_rad);
  const Eigen::Matrix3d rest = (1.0 - fraction) * R * whole.covariance * R.transpose();
  second.covariance = 0.5 * (rest + rest.transpose());
  return {first, second};
}

}  // namespace helixnav::core
