// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace helixnav::cekf {

/// What a search for landmarks near the vehicle needs of one: no marginal, which would cost O(q²).
struct Outlook {
  Eigen::Vector2d mean_m;                 ///< in the world
  double sigma_bound_m;                   ///< at least the root of its covariance's trace
  Eigen::Matrix<double, 2, 3> with_pose;  ///< covariance with (x, y, heading) of the vehicle
};

}  // namespace helixnav::cekf
