// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace helixnav::core {

/// A rows × depth matrix copied into panels of `width` rows, each panel contiguous with `width` as its stride and zero
/// beyond the last row. Columns of a tall matrix are whole pages or powers of two apart, so that a kernel that walks
/// along the depth would miss the first cache at every step; in a panel it reads line after line.
/// Test: core/packed_product_test.cpp.
class Panels {
 public:
  using Source = Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  explicit Panels(Eigen::Index width) : rows_(0), depth_(0), width_(width) {}
  Panels(const Source& from, Eigen::Index width);
  /// Only the columns named.
  Panels(const Source& from, const std::vector<int>& columns, Eigen::Index width);
  /// Of factor·fromᵀ.
  static Panels of_transposed(const Source& from, Eigen::Index width, double factor = 1.0);

  /// Room for a matrix of as many rows and columns: packing it then does not allocate.
  void reserve(Eigen::Index rows, Eigen::Index depth);
  void pack(const Source& from);
  void pack(const Source& from, const std::vector<int>& columns);

  Eigen::Index rows() const { return rows_; }
  Eigen::Index depth() const { return depth_; }
  Eigen::Index width() const { return width_; }
  Eigen::Index count() const { return (rows_ + width_ - 1) / width_; }
  const double* panel(Eigen::Index p) const { return data_.data() + p * width_ * depth_; }

 private:
  Panels(Eigen::Index rows, Eigen::Index depth, Eigen::Index width);
  void set_zero(Eigen::Index rows, Eigen::Index depth);
  void copy_column(const double* source, Eigen::Index k);

  Eigen::Index rows_;
  Eigen::Index depth_;
  Eigen::Index width_;
  std::vector<double> data_;
};

/// Widths that fit the kernels: both panels of a depth of 150 fit in 32 KiB.
constexpr Eigen::Index left_width = 16;
constexpr Eigen::Index right_width = 8;

/// C += left·rightᵀ, bit for bit what add_outer gives. C is column-major with at least left.rows() rows rounded up to
/// eight, padding included: zero is added there.
void add_product(double* C, Eigen::Index stride_C, const Panels& left, const Panels& right);
/// The first `columns` of it.
void add_product(double* C, Eigen::Index stride_C, const Panels& left, const Panels& right, Eigen::Index columns);

/// The same for the lower triangle of a square C; the parts of its tiles above the diagonal get arbitrary values.
void add_product_lower(double* C, Eigen::Index stride_C, const Panels& left, const Panels& right);

}  // namespace helixnav::core
