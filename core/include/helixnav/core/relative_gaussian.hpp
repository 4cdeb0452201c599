// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "helixnav/core/symmetric_matrix.hpp"

namespace helixnav::core {

/// A Gaussian factor over a pose and points, given relative to a reference pose, so that it stays the same wherever the
/// whole is moved: with u = (x, y, heading of the pose; x, y of each point), all in the frame of the reference,
///   χ²(u) = chi2 − 2·vectorᵀδ + δᵀ·information·δ,   δ = u − mean, its heading wrapped.
/// information is (3+2n)×(3+2n), positive semidefinite; vector and mean have 3+2n rows [m, m, rad; m, m; …].
struct RelativeGaussian {
  SymmetricMatrix information;
  Eigen::VectorXd vector;
  Eigen::VectorXd mean;
  double chi2 = 0.0;
};

}  // namespace helixnav::core
