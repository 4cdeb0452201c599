// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "helixnav/core/events.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/sim/scenario.hpp"

namespace helixnav::sim {

/// Measures wheel speed and steering with white noise and a slow error, and turns them into increments.
class Odometer {
 public:
  Odometer(const Scenario& scenario, std::uint64_t seed);

  core::Odometry measure(const core::AckermannSample& truth, core::Nanoseconds t_ns);

 private:
  void drift(double duration_s);

  core::AckermannGeometry geometry_;
  core::AckermannNoise true_noise_;
  core::AckermannNoise assumed_noise_;
  OdometryBias bias_;
  core::RandomStream noise_;
  core::RandomStream slow_;
  double steering_error_sigmas_;
  double speed_error_sigmas_;
};

}  // namespace helixnav::sim
