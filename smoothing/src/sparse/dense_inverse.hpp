// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "cholesky.hpp"

namespace helixnav::smoothing {

/// Z = (L·Lᵀ)⁻¹ among the chosen positions of the elimination order, all pairs of them, a band of columns at a time: the
/// two triangular solves, but only along the paths from the chosen columns to the root of the elimination tree, the second
/// no farther down than the band, and by blocks of columns with the same structure, so that all is dense products.
/// nnz(L on the paths)·n multiplications for n positions. Test: smoothing/marginals_test.cpp.
class DenseInverse {
 public:
  /// Copies what it needs of the factor.
  DenseInverse(const FactorView& L, const std::vector<int>& chosen_positions);

  /// The chosen positions, by their index, in the order of the bands: from the root down.
  const std::vector<int>& order() const { return order_; }

  /// Z(order[i], order[first + k]) for k < count and i < first + count, (first + count) × count.
  Eigen::MatrixXd band(int first, int count) const;

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// Columns of L with the same structure: below each of them are all rows of the first one except their own.
  struct Block {
    int row = 0;                 ///< of its first column among all on the paths, the root's block first
    std::vector<int> below;      ///< rows of the block's boundary
    Eigen::MatrixXd inverse;     ///< L₁₁⁻¹
    Eigen::MatrixXd below_left;  ///< L₂₁·L₁₁⁻¹
  };

  void read_block(const FactorView& L, int first, int width);
  void go_up(std::size_t last, Rows& Y) const;
  void go_down(std::size_t last, Rows& Z) const;

  std::vector<Block> blocks_;
  std::vector<int> row_;  ///< of each position of the elimination order
  int rows_ = 0;
  std::vector<int> order_;
  std::vector<int> chosen_row_;  ///< by order_
  std::vector<std::size_t> block_of_row_;
};

}  // namespace helixnav::smoothing
