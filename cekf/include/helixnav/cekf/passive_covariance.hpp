// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace helixnav::core {
class Panels;
}

namespace helixnav::cekf {

/// Symmetric matrix that keeps only the tiles of its lower triangle and grows without being copied: the covariance of
/// all landmarks that have a slot, as of the last absorbed phase. Memory 4·n² bytes for n rows.
/// Test: cekf/pieces_test.cpp.
class PassiveCovariance {
 public:
  static constexpr int tile = 128;

  int rows() const { return rows_; }
  /// New rows are zero.
  void grow(int rows);
  /// Becomes this symmetric matrix; only its lower triangle is read.
  void assign(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& symmetric);
  double at(int i, int j) const;
  Eigen::Matrix2d block(int slot_i, int slot_j) const;
  /// Columns 2s and 2s+1, rows() × 2.
  void copy_columns(int slot, Eigen::Ref<Eigen::MatrixXd> columns) const;
  /// this += left·rightᵀ over the given columns, a product known to be symmetric; both factors are n × q with
  /// n ≤ rows(). Cost n² flops per column.
  void add_symmetric_product(const Eigen::Ref<const Eigen::MatrixXd>& left,
                             const Eigen::Ref<const Eigen::MatrixXd>& right, const std::vector<int>& columns);
  /// The same with both sides packed (widths of packed_product.hpp). No allocation.
  void add_symmetric_product(const core::Panels& left, const core::Panels& right);
  /// Overwrites rows and columns of the slots; columns is rows() × 2·|slots|.
  void overwrite(const std::vector<int>& slots, const Eigen::Ref<const Eigen::MatrixXd>& columns);
  std::size_t bytes() const { return tiles_.size() * tile * tile * sizeof(double); }

 private:
  using Tile = Eigen::Matrix<double, tile, tile>;
  static std::size_t index(int I, int J) {
    const auto row = static_cast<std::size_t>(I);
    return row * (row + 1) / 2 + static_cast<std::size_t>(J);
  }
  Tile& tile_at(int I, int J) { return tiles_[index(I, J)]; }
  const Tile& tile_at(int I, int J) const { return tiles_[index(I, J)]; }
  void set(int i, int j, double value);
  void add_to_tile(int I, int J, const core::Panels& left, const core::Panels& right);

  std::vector<Tile, Eigen::aligned_allocator<Tile>> tiles_;
  int rows_ = 0;
};

}  // namespace helixnav::cekf
