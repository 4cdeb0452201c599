// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "helixnav/atlas/phase_log.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "loop/tape.hpp"

namespace helixnav::supervisor {

/// A stop of the drive as a phase has it.
struct StopInPhase {
  core::Nanoseconds t_ns = 0;
  int step = 0;  ///< of the phase's log at whose end it was; −1: where the phase begins
};

/// A phase of the drive.
struct DrivePhase {
  std::shared_ptr<const atlas::PhaseLog> log;
  std::optional<core::AbsoluteFix> fix;  ///< where it ends
  std::vector<StopInPhase> stops;
};

/// Which landmarks are worth a place in the map, and what the others of a chain of merges are called now.
struct PhaseNames {
  std::function<bool(core::LandmarkId)> is_worth_it;
  std::function<core::LandmarkId(core::LandmarkId)> now;
};

/// Cuts a stretch of the drive into phases of at least `length_m`, the last one shorter; a fix ends one. `motion` leads
/// from the last stop to where the stretch ends. `begins_drive`: what was seen before the first motion belongs to where
/// the first phase begins; otherwise the vehicle has stood there since the previous phase, which is a step without
/// motion. Odometry is softened (softening), so that every covariance has an inverse.
/// Test: supervisor/smoothing/drive_map_test.cpp.
std::vector<DrivePhase> phases_of(const std::vector<Stop>& stops, const std::optional<core::Odometry>& motion,
                                  double length_m, bool begins_drive, const PhaseNames& names);

/// Added to standard deviations in (x, y, heading) [m, m, rad]: odometry of rank two, a certain start and an exact fix
/// have no inverse. A few ten-thousandths of a truck's drift per metre.
Eigen::Vector3d softening();

/// The start of an atlas: an exactly known one is the map frame itself, any other gets a covariance with an inverse.
core::PoseGaussian softened_start(core::PoseGaussian start);

/// Length of a phase for a sensor of this reach: 20 m for one of 30 m.
double phase_length_m(double reach_m);

}  // namespace helixnav::supervisor
