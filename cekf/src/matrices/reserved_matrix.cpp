// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/cekf/reserved_matrix.hpp"

#include <algorithm>
#include <utility>

namespace helixnav::cekf {

ReservedMatrix::ReservedMatrix(const ReservedMatrix& other) { *this = other; }

ReservedMatrix::ReservedMatrix(ReservedMatrix&& other) noexcept
    : storage_(std::move(other.storage_)), rows_(std::exchange(other.rows_, 0)), cols_(std::exchange(other.cols_, 0)) {}

ReservedMatrix& ReservedMatrix::operator=(const ReservedMatrix& other) {
  if (this == &other) return *this;
  if (other.padded_rows() > storage_.rows() || other.cols_ > storage_.cols()) {
    Eigen::MatrixXd copy = other.storage_.topLeftCorner(other.padded_rows(), other.cols_);
    storage_.swap(copy);
    rows_ = other.rows_;
    cols_ = other.cols_;
    return *this;
  }
  view().setZero();
  rows_ = other.rows_;
  cols_ = other.cols_;
  view() = other.view();
  return *this;
}

ReservedMatrix& ReservedMatrix::operator=(ReservedMatrix&& other) noexcept {
  storage_.swap(other.storage_);
  std::swap(rows_, other.rows_);
  std::swap(cols_, other.cols_);
  return *this;
}

void ReservedMatrix::reserve(Eigen::Index rows, Eigen::Index cols) {
  if (rows <= storage_.rows() && cols <= storage_.cols()) return;
  const Eigen::Index room_rows = std::max(storage_.rows(), (rows + 7) / 8 * 8);
  Eigen::MatrixXd larger = Eigen::MatrixXd::Zero(room_rows, std::max(storage_.cols(), cols));
  larger.topLeftCorner(rows_, cols_) = view();
  storage_.swap(larger);
}

void ReservedMatrix::make_room(Eigen::Index rows, Eigen::Index cols) {
  if (rows <= storage_.rows() && cols <= storage_.cols()) return;
  if (storage_.size() == 0) return reserve(rows, cols);  // only what has grown will grow
  reserve(rows > storage_.rows() ? rows + rows / 8 : rows, cols > storage_.cols() ? cols + cols / 8 : cols);
}

void ReservedMatrix::resize(Eigen::Index rows, Eigen::Index cols) {
  make_room(rows, cols);
  if (rows < rows_) view().bottomRows(rows_ - rows).setZero();
  if (cols < cols_) view().rightCols(cols_ - cols).setZero();
  rows_ = rows;
  cols_ = cols;
}

void ReservedMatrix::set_zero() { view().setZero(); }

}  // namespace helixnav::cekf
