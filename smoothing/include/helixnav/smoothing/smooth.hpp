// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "helixnav/smoothing/optimize.hpp"
#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing {

/// Where the solution starts from.
enum class Start {
  as_given,  ///< the values in the graph
  softened,  ///< the solution of the same problem with soften_odometry, started from the values in the graph
  grown,     ///< grow_start: needs nothing but the measurements
};

struct SmoothOptions {
  Options solver;
  Start start = Start::as_given;
  Eigen::Vector3d soften_sigma{0.05, 0.05, 0.5 * core::pi / 180.0};  ///< x, y, heading [m, m, rad]
  int poses_per_stage = 200;
};

/// optimize() from the chosen start; what `helixnav smooth` calls. Report::start is where the last solution began.
/// Errors as optimize(); the problem is left as it was when anything is thrown.
/// Test: smoothing/victoria_park_test.cpp (all three starts side by side).
Report smooth(Problem& problem, const SmoothOptions& options = {});

}  // namespace helixnav::smoothing
