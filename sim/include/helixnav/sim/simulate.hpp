// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "helixnav/core/recording.hpp"
#include "helixnav/sim/scenario.hpp"

namespace helixnav::sim {

/// Drives a scenario once: odometry every vehicle.odometry_period_s, a scan at the start and after every
/// samples_per_scan samples. The recording starts at the identity with zero covariance; true_poses[i] belongs to scan
/// i, labels are indices of true_landmarks (no_label: clutter), which include every tree that ever existed. The
/// observations of a scan are in random order. The same scenario and seed give the same bytes; world, odometry and
/// scanner draw from streams of their own, so that e.g. different odometry noise leaves truth and scans unchanged.
/// Throws InputError when check_scenario does. Cost: about 10 ms for the large loop. Test: sim/simulate_test.cpp,
/// sim/statistics_test.cpp.
core::Recording simulate(const Scenario& scenario, std::uint64_t seed);

/// The same in a given world, e.g. a hand-made one.
core::Recording simulate_in(const World& world, const Scenario& scenario, std::uint64_t seed);

}  // namespace helixnav::sim
