// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing {

/// One measurement's share of χ² at the present values.
struct Residual {
  enum class Kind { odometry, landmark, fix };
  Kind kind = Kind::landmark;
  int edge = 0;       ///< index in pose_edges, landmark_edges or fix_edges of the graph
  int pose = 0;       ///< index of the pose it was measured at (odometry: that it leads to)
  int landmark = -1;  ///< index, −1 when none
  Eigen::VectorXd e;  ///< measured minus predicted, in the measurement's units
  double nis = 0.0;   ///< eᵀC⁻¹e
  std::string name;   ///< "pose 203 sees landmark 17"
};

/// The `count` measurements with the largest nis per row, largest first. Errors as check_problem.
/// Test: smoothing/residuals_test.cpp.
std::vector<Residual> largest_residuals(const Problem& problem, std::size_t count);

}  // namespace helixnav::smoothing
