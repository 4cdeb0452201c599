// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/sim/scenario.hpp"

namespace helixnav::sim {

/// Measures wheel speed and steering with white noise and a slow error, and turns them into increments; slips of the
/// vehicle between two samples are not included.
class Odometer {
 public:
  Odometer(const Scenario& scenario, std::uint64_t seed);

  core::Odometry measure(const core::AckermannSample& truth, core::Nanoseconds t_ns);

  /// When the vehicle has slipped so far.
  const std::vector<core::Nanoseconds>& slips() const { return slips_; }

 private:
  void drift(double duration_s);
  core::Pose2 draw_slip();

  core::AckermannGeometry geometry_;
  core::AckermannNoise true_noise_;
  core::AckermannNoise assumed_noise_;
  OdometryBias bias_;
  SlipOptions slip_;
  core::RandomStream noise_;
  core::RandomStream slow_;
  core::RandomStream slip_random_;
  double steering_error_sigmas_;
  double speed_error_sigmas_;
  double metres_to_slip_;
  std::vector<core::Nanoseconds> slips_;
};

}  // namespace helixnav::sim
