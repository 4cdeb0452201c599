// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::supervisor {

/// By how much a closing costs more than its noise with odometry as it was measured, and what odometry was allowed for it.
struct OddClosing {
  double excess = 0.0;           ///< of χ² over its degrees of freedom
  double odometry_factor = 1.0;  ///< on the covariance of motion over the loop; 0: a jump
  double loop_m = 0.0;
  double path_m = 0.0;  ///< of the vehicle when it was closed
};

}  // namespace helixnav::supervisor
