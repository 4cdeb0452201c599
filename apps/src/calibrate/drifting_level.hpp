// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace helixnav::apps {

/// The expected value of a level that is seen with white noise and drifts as a random walk. The restricted likelihood
/// decides how much of the changes is drift, and unless drift is evident (5 %) the level is constant. So noise alone
/// does not make the level change. Cost: linear, for each of a few dozen ratios of drift to noise. `seen` at equal
/// weights, `apart_s` the time from each to the next [s > 0], one fewer than seen.
/// Equation: local level model, Durbin & Koopman, Time Series Analysis by State Space Methods, ch. 2.
/// Test: apps/calibrate/drifting_level_test.cpp
Eigen::VectorXd drifting_level(const Eigen::VectorXd& seen, const Eigen::VectorXd& apart_s);

}  // namespace helixnav::apps
