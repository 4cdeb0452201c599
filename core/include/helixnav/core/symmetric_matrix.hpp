// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace helixnav::core {

/// A symmetric matrix that is put away: it keeps each element once, half the memory of an Eigen matrix, with which one computes (full()).
/// Test: core/symmetric_matrix_test.cpp.
class SymmetricMatrix {
 public:
  SymmetricMatrix() = default;
  /// Anything square that Eigen can evaluate; its lower triangle is taken.
  template <class Derived>
  SymmetricMatrix(const Eigen::EigenBase<Derived>& A) : rows_(A.rows()) {  // NOLINT(google-explicit-constructor)
    const Eigen::MatrixXd dense = A.derived();
    lower_.reserve(static_cast<std::size_t>(rows_ * (rows_ + 1) / 2));
    for (Eigen::Index j = 0; j < rows_; ++j) lower_.insert(lower_.end(), &dense(j, j), &dense(j, j) + (rows_ - j));
  }

  Eigen::Index rows() const { return rows_; }

  Eigen::MatrixXd full() const {
    Eigen::MatrixXd A(rows_, rows_);
    const double* next = lower_.data();
    for (Eigen::Index j = 0; j < rows_; ++j) {
      for (Eigen::Index i = j; i < rows_; ++i) A(i, j) = A(j, i) = *next++;
    }
    return A;
  }

  bool all_finite() const {
    return Eigen::Map<const Eigen::VectorXd>(lower_.data(), static_cast<Eigen::Index>(lower_.size())).allFinite();
  }

 private:
  Eigen::Index rows_ = 0;
  std::vector<double> lower_;  ///< column by column
};

}  // namespace helixnav::core
