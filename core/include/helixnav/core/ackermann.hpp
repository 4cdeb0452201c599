// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/events.hpp"

namespace helixnav::core {

/// Geometry of a car-like vehicle whose speed is measured at one rear wheel; reference point: middle of the rear axle.
struct AckermannGeometry {
  double wheelbase_m = 2.83;       ///< L, rear axle to front axle
  double encoder_offset_m = 0.76;  ///< H, rear axle's middle to the wheel with the encoder (left positive)
};

/// White noise of one (speed, steering) sample. Speed and steering are taken as independent between samples.
struct AckermannNoise {
  double sigma_speed_mps = 1.0;
  double sigma_steering_rad = 0.07;
};

/// One sample: wheel speed [m/s] and steering angle [rad, positive to the left], held for `duration_s`.
struct AckermannSample {
  double wheel_speed_mps = 0.0;
  double steering_rad = 0.0;
  double duration_s = 0.0;
};

/// Body-frame increment of the rear axle with its covariance: v = v_e / (1 − H/L·tan α), ω = v/L·tan α, exact on the
/// arc of constant v and ω. The covariance is J·diag(σ_v², σ_α²)·Jᵀ with the analytic J (3×2); it has rank two.
/// Steering must stay below atan(L/H), where the encoder's wheel would stand still (75° by default).
/// t_ns of the result is left 0 for the caller. Source: victoria_park README (vehicle), ACFR.
/// Test: core/ackermann_test.cpp (Jacobian against central differences, arc against fine integration).
Odometry ackermann_increment(const AckermannGeometry& geometry, const AckermannNoise& noise,
                             const AckermannSample& sample);

}  // namespace helixnav::core
