// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/random.hpp"

namespace helixnav::sim {

/// Points about half a metre apart on closed curves, driven for `laps` laps; once round is `lap_length_m` long.
using Polyline = std::vector<Eigen::Vector2d>;

/// Closed curve with two random waves on a circle; sharpest bend about a third of its mean radius.
Polyline wavy_loop(double lap_length_m, int laps, core::RandomStream& random);

/// The same, but from two thirds of the first lap on it swings out to run `offset_m` outside itself.
Polyline spiral(double lap_length_m, double offset_m, int laps, core::RandomStream& random);

/// Two lobes that cross in the middle, where it begins.
Polyline figure_of_eight(double lap_length_m, int laps, core::RandomStream& random);

Polyline circle(double lap_length_m, int laps);

/// Two straights and two half circles; it starts `run_up_m` into a straight.
Polyline racetrack(double lap_length_m, double turn_radius_m, double run_up_m, int laps);

}  // namespace helixnav::sim
