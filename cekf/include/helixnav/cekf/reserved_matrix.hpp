// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace helixnav::cekf {

/// Column-major matrix that grows and shrinks in place, so that the per-step path never allocates. Columns begin at
/// multiples of eight doubles and everything outside rows() × cols() is zero, so kernels may run over whole blocks of
/// eight rows. A copy is compact; assignment keeps the storage of the target if it is large enough.
/// Test: cekf/pieces_test.cpp.
class ReservedMatrix {
 public:
  using View = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  using ConstView = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  ReservedMatrix() = default;
  ReservedMatrix(Eigen::Index rows, Eigen::Index cols) { resize(rows, cols); }
  ReservedMatrix(const ReservedMatrix& other);
  ReservedMatrix(ReservedMatrix&& other) noexcept;
  ReservedMatrix& operator=(const ReservedMatrix& other);
  ReservedMatrix& operator=(ReservedMatrix&& other) noexcept;
  ~ReservedMatrix() = default;

  /// Keeps the common part; new elements are zero.
  void resize(Eigen::Index rows, Eigen::Index cols);
  /// Room for rows × cols without a later allocation.
  void reserve(Eigen::Index rows, Eigen::Index cols);
  /// Room for a resize to rows × cols, including what a resize would add for later ones (an eighth more, unless it is
  /// the first): that resize then cannot throw.
  void make_room(Eigen::Index rows, Eigen::Index cols);
  void set_zero();

  View view() { return {storage_.data(), rows_, cols_, Eigen::OuterStride<>(stride())}; }
  ConstView view() const { return {storage_.data(), rows_, cols_, Eigen::OuterStride<>(stride())}; }

  Eigen::Index rows() const { return rows_; }
  Eigen::Index cols() const { return cols_; }
  Eigen::Index padded_rows() const { return (rows_ + 7) / 8 * 8; }
  Eigen::Index stride() const { return storage_.rows(); }
  double* col(Eigen::Index j) { return storage_.data() + j * stride(); }
  const double* col(Eigen::Index j) const { return storage_.data() + j * stride(); }
  std::size_t bytes() const { return static_cast<std::size_t>(padded_rows() * cols_) * sizeof(double); }

 private:
  Eigen::MatrixXd storage_;
  Eigen::Index rows_ = 0;
  Eigen::Index cols_ = 0;
};

}  // namespace helixnav::cekf
