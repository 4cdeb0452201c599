// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace helixnav::apps {

// Test: apps/calibrate/swings_test.cpp

/// The constants at the end of each round, from which the next one begins.
using RoundValues = std::vector<Eigen::VectorXd>;

/// How far each constant swung in the last three rounds, in standard deviations; 0 if these are 0, and after only one
/// round.
Eigen::VectorXd swings(const RoundValues& rounds, const Eigen::VectorXd& sigmas);

/// Whether the last round ended where an earlier one did (within a tenth of a standard deviation), other than the one just before
/// it: the same constants give the same associations, and these the same constants again.
bool repeats(const RoundValues& rounds, const Eigen::VectorXd& sigmas);

}  // namespace helixnav::apps
