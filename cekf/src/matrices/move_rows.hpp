// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/cekf/reserved_matrix.hpp"

namespace helixnav::cekf {

/// Two rows of a matrix, and where they go.
struct MovedRows {
  Eigen::Index from;
  Eigen::Index to;
};

/// In each column, the contents of the rows `from` move to the rows `to`; all others are zero. `column` has room for one
/// of them. No allocation.
inline void move_rows(const std::vector<MovedRows>& moves, Eigen::VectorXd& column, ReservedMatrix& matrix) {
  auto view = matrix.view();
  for (Eigen::Index j = 0; j < view.cols(); ++j) {
    column.head(view.rows()) = view.col(j);
    view.col(j).setZero();
    for (const MovedRows& one : moves) view.col(j).segment<2>(one.to) = column.segment<2>(one.from);
  }
}

}  // namespace helixnav::cekf
