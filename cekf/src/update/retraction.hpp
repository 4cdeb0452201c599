// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace helixnav::cekf {

/// V(θ) = [[a, −b], [b, a]] with a + ib = (e^{iθ} − 1)/(iθ): how a point moves, by V·δp, when the correction turns the
/// world by θ. THEORY §1b.
inline Eigen::Matrix2d turning_average(double theta_rad) {
  double a = 1.0 - theta_rad * theta_rad / 6.0;
  double b = theta_rad / 2.0 * (1.0 - theta_rad * theta_rad / 12.0);
  if (std::abs(theta_rad) > 1e-3) {
    a = std::sin(theta_rad) / theta_rad;
    const double half_sine = std::sin(0.5 * theta_rad);
    b = 2.0 * half_sine * half_sine / theta_rad;
  }
  Eigen::Matrix2d V;
  V << a, -b, b, a;
  return V;
}

/// dV/dθ.
inline Eigen::Matrix2d turning_average_derivative(double theta_rad) {
  double a = -theta_rad / 3.0;
  double b = 0.5 - theta_rad * theta_rad / 8.0;
  if (std::abs(theta_rad) > 1e-3) {
    const double half_sine = std::sin(0.5 * theta_rad);
    a = (std::cos(theta_rad) - std::sin(theta_rad) / theta_rad) / theta_rad;
    b = (std::sin(theta_rad) - 2.0 * half_sine * half_sine / theta_rad) / theta_rad;
  }
  Eigen::Matrix2d dV;
  dV << a, -b, b, a;
  return dV;
}

/// J·p, a quarter turn counter-clockwise.
inline Eigen::Vector2d quarter_turn(const Eigen::Vector2d& p) { return {-p.y(), p.x()}; }

}  // namespace helixnav::cekf
