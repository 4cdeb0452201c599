// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/cekf/passive_covariance.hpp"

#include <algorithm>

#include "add_outer.hpp"

namespace helixnav::cekf {
namespace {

constexpr int tile_rows = PassiveCovariance::tile;

/// Rows [I·tile, …) of `from`, zero below its end, as a compact tile × q block.
void pack(const Eigen::Ref<const Eigen::MatrixXd>& from, int I, Eigen::MatrixXd& packed) {
  const Eigen::Index first = static_cast<Eigen::Index>(I) * tile_rows;
  const Eigen::Index rows = std::min<Eigen::Index>(tile_rows, from.rows() - first);
  packed.resize(tile_rows, from.cols());
  packed.topRows(rows) = from.middleRows(first, rows);
  packed.bottomRows(tile_rows - rows).setZero();
}

}  // namespace

void PassiveCovariance::grow(int rows) {
  if (rows <= rows_) return;
  rows_ = rows;
  const std::size_t side = static_cast<std::size_t>((rows + tile - 1) / tile);
  tiles_.resize(side * (side + 1) / 2, Tile::Zero());
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
  Eigen::Matrix2d result;
  for (int c = 0; c < 2; ++c) {
    for (int r = 0; r < 2; ++r) result(r, c) = at(2 * slot_i + r, 2 * slot_j + c);
  }
  return result;
}

void PassiveCovariance::copy_columns(int slot, Eigen::Ref<Eigen::MatrixXd> columns) const {
  for (int c = 0; c < 2; ++c) {
    const int j = 2 * slot + c;
    const int J = j / tile;
    for (int i = 0; i < std::min(J * tile, rows_); ++i) columns(i, c) = tile_at(J, i / tile)(j % tile, i % tile);
    for (int i = J * tile; i < rows_; ++i) columns(i, c) = at(i, j);
  }
}

void PassiveCovariance::add_symmetric_product(const Eigen::Ref<const Eigen::MatrixXd>& left,
                                              const Eigen::Ref<const Eigen::MatrixXd>& right) {
  if (left.rows() == 0 || left.cols() == 0) return;
  const int side = static_cast<int>((left.rows() + tile - 1) / tile);
  std::vector<Eigen::MatrixXd> packed_right(static_cast<std::size_t>(side));
  for (int J = 0; J < side; ++J) pack(right, J, packed_right[static_cast<std::size_t>(J)]);
  Eigen::MatrixXd packed_left;
  for (int I = 0; I < side; ++I) {
    pack(left, I, packed_left);
    for (int J = 0; J <= I; ++J) {
      const Eigen::MatrixXd& r = packed_right[static_cast<std::size_t>(J)];
      add_outer(tile_at(I, J).data(), tile, tile, tile, packed_left.data(), tile, r.data(), tile, left.cols());
    }
  }
}

void PassiveCovariance::overwrite(const std::vector<int>& slots, const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  for (std::size_t k = 0; k < slots.size(); ++k) {
    for (int c = 0; c < 2; ++c) {
      const int j = 2 * slots[k] + c;
      for (int i = 0; i < rows_; ++i) set(i, j, columns(i, 2 * static_cast<Eigen::Index>(k) + c));
    }
  }
}

}  // namespace helixnav::cekf
