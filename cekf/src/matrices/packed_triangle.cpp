// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/cekf/packed_triangle.hpp"

namespace helixnav::cekf {

PackedTriangle::PackedTriangle(const ReservedMatrix& symmetric)
    : rows_(symmetric.rows()), lower_(rows_ * (rows_ + 1) / 2) {
  Eigen::Index first = 0;
  for (Eigen::Index j = 0; j < rows_; ++j) {
    lower_.segment(first, rows_ - j) = symmetric.view().col(j).tail(rows_ - j);
    first += rows_ - j;
  }
}

ReservedMatrix PackedTriangle::unpacked() const {
  ReservedMatrix symmetric(rows_, rows_);
  auto view = symmetric.view();
  Eigen::Index first = 0;
  for (Eigen::Index j = 0; j < rows_; ++j) {
    view.col(j).tail(rows_ - j) = lower_.segment(first, rows_ - j);
    view.row(j).tail(rows_ - j) = lower_.segment(first, rows_ - j).transpose();
    first += rows_ - j;
  }
  return symmetric;
}

}  // namespace helixnav::cekf
