// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/cekf/passive_covariance.hpp"

#include <algorithm>

#include "helixnav/core/add_outer.hpp"
#include "helixnav/core/packed_product.hpp"

namespace helixnav::cekf {

void PassiveCovariance::grow(int rows) {
  if (rows <= rows_) return;
  const std::size_t side = static_cast<std::size_t>((rows + tile - 1) / tile);
  const std::size_t tiles = side * (side + 1) / 2;
  if (tiles > tiles_.capacity()) {  // resize would take room for up to as many again, and a map grows slowly
    const std::size_t roomy = side + side / 16;
    tiles_.reserve(roomy * (roomy + 1) / 2);
  }
  tiles_.resize(tiles, Tile::Zero());
  rows_ = rows;
}

void PassiveCovariance::assign(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& symmetric) {
  tiles_.clear();
  rows_ = 0;
  grow(static_cast<int>(symmetric.rows()));
  for (int i = 0; i < rows_; i += tile) {
    for (int j = 0; j <= i; j += tile) {
      const int rows = std::min(tile, rows_ - i);
      const int columns = std::min(tile, rows_ - j);
      tile_at(i / tile, j / tile).topLeftCorner(rows, columns) = symmetric.block(i, j, rows, columns);
    }
  }
}

double PassiveCovariance::at(int i, int j) const {
  if (i < j) std::swap(i, j);
  return tile_at(i / tile, j / tile)(i % tile, j % tile);
}

void PassiveCovariance::set(int i, int j, double value) {
  if (i < j) std::swap(i, j);
  tile_at(i / tile, j / tile)(i % tile, j % tile) = value;
}

Eigen::Matrix2d PassiveCovariance::block(int slot_i, int slot_j) const {
  const int i = 2 * std::max(slot_i, slot_j);
  const int j = 2 * std::min(slot_i, slot_j);
  Eigen::Matrix2d result = tile_at(i / tile, j / tile).block<2, 2>(i % tile, j % tile);
  if (i == j) result(0, 1) = result(1, 0);  // above the diagonal
  if (slot_i < slot_j) result.transposeInPlace();
  return result;
}

void PassiveCovariance::copy_columns(int slot, Eigen::Ref<Eigen::MatrixXd> columns) const {
  for (int c = 0; c < 2; ++c) {
    const int j = 2 * slot + c;
    const int J = j / tile;
    for (int i = 0; i < std::min(J * tile, rows_); ++i) columns(i, c) = tile_at(J, i / tile)(j % tile, i % tile);
    for (int i = J * tile; i < j; ++i) columns(i, c) = at(i, j);
    for (int I = J; I * tile < rows_; ++I) {
      const int first = std::max(j, I * tile);
      const int count = std::min((I + 1) * tile, rows_) - first;
      if (count > 0) columns.col(c).segment(first, count) = tile_at(I, J).col(j % tile).segment(first % tile, count);
    }
  }
}

void PassiveCovariance::add_symmetric_product(const Eigen::Ref<const Eigen::MatrixXd>& left,
                                              const Eigen::Ref<const Eigen::MatrixXd>& right,
                                              const std::vector<int>& columns) {
  add_symmetric_product(core::Panels(left, columns, core::left_width), core::Panels(right, columns, core::right_width));
}

void PassiveCovariance::add_symmetric_product(const core::Panels& left, const core::Panels& right) {
  for (int I = 0; I * tile < left.rows(); ++I) {
    for (int J = 0; J <= I; ++J) add_to_tile(I, J, left, right);
  }
}

/// Tile by tile, so that the panels of two tiles, and the tile, stay in the second-level cache meanwhile.
void PassiveCovariance::add_to_tile(int I, int J, const core::Panels& left, const core::Panels& right) {
  constexpr int lefts = tile / static_cast<int>(core::left_width);
  constexpr int rights = tile / static_cast<int>(core::right_width);
  double* const C = tile_at(I, J).data();
  for (int l = 0; l < lefts && I * lefts + l < left.count(); ++l) {
    const int row = l * static_cast<int>(core::left_width);
    for (int r = 0; r < rights && J * rights + r < right.count(); ++r) {
      const int column = r * static_cast<int>(core::right_width);
      if (I == J && column >= row + core::left_width) break;  // above the diagonal
      core::add_outer(C + row + column * tile, tile, core::left_width, core::right_width, left.panel(I * lefts + l),
                      core::left_width, right.panel(J * rights + r), core::right_width, left.depth());
    }
  }
}

void PassiveCovariance::overwrite(const std::vector<int>& slots, const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  const int rows = static_cast<int>(columns.rows());  // those of the phase; a later one may have made room for more
  for (std::size_t k = 0; k < slots.size(); ++k) {
    for (int c = 0; c < 2; ++c) {
      const int j = 2 * slots[k] + c;
      for (int i = 0; i < rows; ++i) set(i, j, columns(i, 2 * static_cast<Eigen::Index>(k) + c));
    }
  }
}

}  // namespace helixnav::cekf
