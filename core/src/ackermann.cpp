// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/ackermann.hpp"

#include <cmath>

namespace helixnav::core {
namespace {

/// sin(a)/a, (1−cos a)/a and their derivatives by a, without cancellation near 0.
struct ArcFunctions {
  double sinc;
  double cosc;
  double d_sinc;
  double d_cosc;
};

ArcFunctions arc_functions(double a) {
  if (std::abs(a) < 1e-3) {
    const double a2 = a * a;
    return {1.0 - a2 / 6.0 + a2 * a2 / 120.0, a * (0.5 - a2 / 24.0), a * (-1.0 / 3.0 + a2 / 30.0), 0.5 - a2 / 8.0};
  }
  const double s = std::sin(a);
  const double c = std::cos(a);
  return {s / a, (1.0 - c) / a, (a * c - s) / (a * a), (a * s - (1.0 - c)) / (a * a)};
}

}  // namespace

Odometry ackermann_increment(const AckermannGeometry& geometry, const AckermannNoise& noise,
                             const AckermannSample& sample) {
  const double tan_steering = std::tan(sample.steering_rad);
  const double d_tan = 1.0 + tan_steering * tan_steering;
  const double wheel_ratio = 1.0 / (1.0 - geometry.encoder_offset_m / geometry.wheelbase_m * tan_steering);
  const double curvature_per_m = tan_steering / geometry.wheelbase_m;

  const double length_m = sample.wheel_speed_mps * wheel_ratio * sample.duration_s;
  const double turn_rad = length_m * curvature_per_m;
  const double d_length_d_speed = wheel_ratio * sample.duration_s;
  const double d_length_d_steering = length_m * wheel_ratio * geometry.encoder_offset_m / geometry.wheelbase_m * d_tan;
  const double d_turn_d_speed = d_length_d_speed * curvature_per_m;
  const double d_turn_d_steering = d_length_d_steering * curvature_per_m + length_m * d_tan / geometry.wheelbase_m;

  const ArcFunctions arc = arc_functions(turn_rad);
  Eigen::Matrix<double, 3, 2> J_length_turn;
  J_length_turn << arc.sinc, length_m * arc.d_sinc,  //
      arc.cosc, length_m * arc.d_cosc,               //
      0.0, 1.0;
  Eigen::Matrix2d J_input;
  J_input << d_length_d_speed, d_length_d_steering, d_turn_d_speed, d_turn_d_steering;
  const Eigen::Matrix<double, 3, 2> J = J_length_turn * J_input;

  Odometry odometry;
  odometry.T_before_after = Pose2(length_m * arc.sinc, length_m * arc.cosc, turn_rad);
  const Eigen::Vector2d variance(noise.sigma_speed_mps * noise.sigma_speed_mps,
                                 noise.sigma_steering_rad * noise.sigma_steering_rad);
  odometry.covariance = J * variance.asDiagonal() * J.transpose();
  return odometry;
}

}  // namespace helixnav::core
