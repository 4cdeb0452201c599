// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/mirror_lower.hpp"

#include <algorithm>

namespace helixnav::core {

void mirror_lower(Eigen::Ref<Eigen::MatrixXd> P) {
  constexpr Eigen::Index tile = 64;
  const Eigen::Index n = P.cols();
  for (Eigen::Index j = 0; j < n; j += tile) {
    const Eigen::Index columns = std::min(tile, n - j);
    for (Eigen::Index column = j; column < j + columns; ++column) {
      for (Eigen::Index row = column + 1; row < j + columns; ++row) P(column, row) = P(row, column);
    }
    for (Eigen::Index i = j + columns; i < n; i += tile) {
      const Eigen::Index rows = std::min(tile, n - i);
      P.block(j, i, columns, rows) = P.block(i, j, rows, columns).transpose();
    }
  }
}

}  // namespace helixnav::core
