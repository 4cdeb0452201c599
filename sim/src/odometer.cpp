// SPDX-License-Identifier: BSD-3-Clause
#include "odometer.hpp"

#include <cmath>

namespace helixnav::sim {

Odometer::Odometer(const Scenario& scenario, std::uint64_t seed)
    : geometry_(scenario.vehicle.geometry),
      true_noise_(scenario.true_noise.odometry),
      assumed_noise_(scenario.assumed_noise.odometry),
      bias_(scenario.bias),
      noise_(seed, "sim.odometry"),
      slow_(seed, "sim.odometry.bias"),
      steering_error_sigmas_(slow_.normal()),
      speed_error_sigmas_(slow_.normal()) {}

core::Odometry Odometer::measure(const core::AckermannSample& truth, core::Nanoseconds t_ns) {
  core::AckermannSample measured = truth;
  measured.wheel_speed_mps *= 1.0 + bias_.sigma_speed_scale * speed_error_sigmas_;
  measured.wheel_speed_mps += noise_.normal(0.0, true_noise_.sigma_speed_mps);
  measured.steering_rad += bias_.sigma_steering_rad * steering_error_sigmas_;
  measured.steering_rad += noise_.normal(0.0, true_noise_.sigma_steering_rad);
  drift(truth.duration_s);
  core::Odometry odometry = core::ackermann_increment(geometry_, assumed_noise_, measured);
  odometry.t_ns = t_ns;
  return odometry;
}

void Odometer::drift(double duration_s) {
  const double keep = std::exp(-duration_s / bias_.time_constant_s);
  const double renew = std::sqrt(1.0 - keep * keep);
  steering_error_sigmas_ = keep * steering_error_sigmas_ + renew * slow_.normal();
  speed_error_sigmas_ = keep * speed_error_sigmas_ + renew * slow_.normal();
}

}  // namespace helixnav::sim
