// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "helixnav/smoothing/optimize.hpp"
#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing {

/// optimize() with a way out of a bad start: with `soften_sigma` the problem is first solved with softened odometry, then
/// as given from where that ended. The report is of the second run; its start is the first one's end.
/// Errors as optimize(). Test: smoothing/victoria_park_test.cpp.
struct SmoothOptions {
  Options solver;
  std::optional<Eigen::Vector3d> soften_sigma;  ///< x, y, heading [m, m, rad]
};
Report smooth(Problem& problem, const SmoothOptions& options = {});

}  // namespace helixnav::smoothing
