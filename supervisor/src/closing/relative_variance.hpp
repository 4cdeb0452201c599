// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace helixnav::supervisor {

/// tr Cov of the difference of two points whose coordinates begin in rows i and j of the joint state.
inline double relative_variance_m2(const Eigen::MatrixXd& P, Eigen::Index i, Eigen::Index j) {
  return P.block<2, 2>(i, i).trace() + P.block<2, 2>(j, j).trace() - 2.0 * P.block<2, 2>(i, j).trace();
}

}  // namespace helixnav::supervisor
