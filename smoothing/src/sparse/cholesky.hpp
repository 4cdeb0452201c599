// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "helixnav/smoothing/optimize.hpp"

namespace helixnav::smoothing {

/// L of P·H·Pᵀ = L·Lᵀ by columns, rows ascending, the diagonal first; views into the factor, valid until the next
/// factorisation.
struct FactorView {
  int columns = 0;
  const int* column_start = nullptr;
  const int* column_size = nullptr;
  const int* row_index = nullptr;
  const double* values = nullptr;
  const int* permutation = nullptr;  ///< [k] the column of H eliminated as k-th
};

/// Sparse Cholesky factorisation of matrices of one pattern, by CHOLMOD's simplicial LLᵀ.
class Cholesky {
 public:
  /// Orders and analyses the upper triangle with this pattern; the vectors must outlive the object.
  Cholesky(const std::vector<int>& column_start, const std::vector<int>& row_index, Ordering ordering);
  ~Cholesky();
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  /// Factorises. Returns −1, or the column of H at which it proved not to be positive definite: where the pivot is not
  /// above `smallest_pivot` times its diagonal element.
  int factorize(const std::vector<double>& values, double smallest_pivot = 0.0);

  /// x = H⁻¹b with the last successful factorisation.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);

  FactorView factor() const;
  Ordering ordering_kept() const;
  double nonzeros() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace helixnav::smoothing
