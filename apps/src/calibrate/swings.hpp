// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace helixnav::apps {

// Test: apps/calibrate/swings_test.cpp

/// The constants as each round left them, from which the next one begins.
using RoundValues = std::vector<Eigen::VectorXd>;

/// How far each constant went to and fro in the last three rounds, in standard deviations; 0 where these are 0, and of one
/// round.
Eigen::VectorXd swings(const RoundValues& rounds, const Eigen::VectorXd& sigmas);

/// Whether the last round ended where an earlier one did (by a tenth of a standard deviation), but for the one before it: with the
/// same constants come the same associations, and with these the same constants again.
bool repeats(const RoundValues& rounds, const Eigen::VectorXd& sigmas);

}  // namespace helixnav::apps
