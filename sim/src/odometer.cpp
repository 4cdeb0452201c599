// SPDX-License-Identifier: BSD-3-Clause
#include "odometer.hpp"

#include <cmath>
#include <limits>

namespace helixnav::sim {
namespace {

double draw_metres_to_slip(const SlipOptions& slip, core::RandomStream& random) {
  if (slip.every_m <= 0.0) return std::numeric_limits<double>::infinity();
  return -slip.every_m * std::log1p(-random.uniform(0.0, 1.0));
}

}  // namespace

Odometer::Odometer(const Scenario& scenario, std::uint64_t seed)
    : geometry_(scenario.vehicle.geometry),
      true_noise_(scenario.true_noise.odometry),
      assumed_noise_(scenario.assumed_noise.odometry),
      bias_(scenario.bias),
      slip_(scenario.slip),
      noise_(seed, "sim.odometry"),
      slow_(seed, "sim.odometry.bias"),
      slip_random_(seed, "sim.odometry.slip"),
      steering_error_sigmas_(slow_.normal()),
      speed_error_sigmas_(slow_.normal()),
      metres_to_slip_(draw_metres_to_slip(slip_, slip_random_)) {}

core::Odometry Odometer::measure(const core::AckermannSample& truth, core::Nanoseconds t_ns) {
  core::AckermannSample measured = truth;
  measured.wheel_speed_mps *= 1.0 + bias_.sigma_speed_scale * speed_error_sigmas_;
  measured.wheel_speed_mps += noise_.normal(0.0, true_noise_.sigma_speed_mps);
  measured.steering_rad += bias_.sigma_steering_rad * steering_error_sigmas_;
  measured.steering_rad += noise_.normal(0.0, true_noise_.sigma_steering_rad);
  drift(truth.duration_s);
  core::Odometry odometry = core::ackermann_increment(geometry_, assumed_noise_, measured);
  odometry.t_ns = t_ns;
  metres_to_slip_ -= truth.wheel_speed_mps * truth.duration_s;
  if (metres_to_slip_ <= 0.0) {
    odometry.T_before_after = core::compose(odometry.T_before_after, core::inverse(draw_slip()));
    metres_to_slip_ = draw_metres_to_slip(slip_, slip_random_);
    slips_.push_back(t_ns);
  }
  return odometry;
}

/// T_before_after of a slip, in the frame of the vehicle before it.
core::Pose2 Odometer::draw_slip() {
  const double distance_m = slip_random_.uniform(slip_.distance_m.min, slip_.distance_m.max);
  const double direction_rad = slip_random_.uniform(-core::pi, core::pi);
  const double turn_rad = slip_random_.uniform(slip_.turn_rad.min, slip_.turn_rad.max);
  const double side = slip_random_.bernoulli(0.5) ? 1.0 : -1.0;
  return {distance_m * std::cos(direction_rad), distance_m * std::sin(direction_rad), side * turn_rad};
}

void Odometer::drift(double duration_s) {
  const double keep = std::exp(-duration_s / bias_.time_constant_s);
  const double renew = std::sqrt(1.0 - keep * keep);
  steering_error_sigmas_ = keep * steering_error_sigmas_ + renew * slow_.normal();
  speed_error_sigmas_ = keep * speed_error_sigmas_ + renew * slow_.normal();
}

}  // namespace helixnav::sim
