// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/angle.hpp"
#include "helixnav/sim/simulate.hpp"

namespace helixnav::sim {

/// Two laps of a circle of 200 m among 25 landmarks about 15 m apart, seen up to 30 m away; 400 scans.
inline Scenario wide_circuit() {
  Scenario s = named_scenario("circuit");
  s.world.loop_length_m = {200.0, 200.0};
  s.world.drive_on_m = 200.0;
  s.world.returns = 1;
  s.world.circuit_landmarks = 25;
  s.vehicle.geometry = {2.0, 0.0};
  s.vehicle.speed_mps = 2.0;
  s.vehicle.odometry_period_s = 0.25;
  s.vehicle.samples_per_scan = 2;
  s.vehicle.lookahead_m = 4.0;
  s.scanner.field_of_view = {0.5, 30.0, -core::pi, core::pi};
  s.scanner.detection_probability = 0.95;
  s.true_noise.odometry = {0.1, 0.02};
  s.true_noise.sigma_range_m = 0.1;
  s.true_noise.sigma_bearing_rad = 1.0 * core::pi / 180.0;
  s.assumed_noise = s.true_noise;
  return s;
}

}  // namespace helixnav::sim
