// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/ackermann.hpp"
#include "helixnav/core/se2.hpp"
#include "helixnav/sim/scenario.hpp"

namespace helixnav::sim {

/// One true sample of driving: what the wheels did, where that led and how far along the route that is.
struct DriveStep {
  core::AckermannSample sample;
  core::Pose2 T_world_robot;  ///< after the sample
  double along_m = 0.0;       ///< after the sample
};

/// Drives the route by pure pursuit from the identity until `drive_m` along it. Truth is the exact arc of each sample.
std::vector<DriveStep> drive(const Route& route, double drive_m, const VehicleOptions& vehicle);

}  // namespace helixnav::sim
