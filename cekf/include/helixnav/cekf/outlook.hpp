// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace helixnav::cekf {

/// What a search for landmarks near the vehicle needs to know of each: not a marginal, which would
/// cost O(q²).
struct Outlook {
  Eigen::Vector2d mean_m;                 ///< in the world frame
  double sigma_bound_m;                   ///< at least the root of the trace of its covariance
  Eigen::Matrix<double, 2, 3> with_pose;  ///< covariance with (x, y, heading) of the vehicle
};

}  // namespace helixnav::cekf
