// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace helixnav::cekf {

/// The weights of an anchor that the phase never saw, and through which it saw nothing, are still as they began: their
/// columns of M are zero. Those of all others.
inline std::vector<int> columns_not_zero(const Eigen::MatrixXd& M) {
  std::vector<int> columns;
  for (int k = 0; k < static_cast<int>(M.cols()); ++k) {
    if (!M.col(k).isZero(0.0)) columns.push_back(k);
  }
  return columns;
}

}  // namespace helixnav::cekf
