// SPDX-License-Identifier: BSD-3-Clause
#include "dense_inverse.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "paths_to_root.hpp"

namespace helixnav::smoothing {
namespace {

using Index = Eigen::Index;

constexpr int widest = 64;  ///< columns of a block

/// Column j + 1 is the parent of j and has the rows of j except j itself.
bool continues(const FactorView& L, int j) {
  return parent(L, j) == j + 1 && L.column_size[j] == L.column_size[j + 1] + 1;
}

}  // namespace

DenseInverse::DenseInverse(const FactorView& L, const std::vector<int>& chosen_positions)
    : row_(static_cast<std::size_t>(L.columns), -1) {
  const std::vector<char> on_path = columns_on_paths(L, chosen_positions);
  for (int j = L.columns - 1; j >= 0; --j) {
    if (!on_path[static_cast<std::size_t>(j)]) continue;
    int first = j;
    while (first > 0 && j - first + 1 < widest && on_path[static_cast<std::size_t>(first - 1)] &&
           continues(L, first - 1))
      --first;
    read_block(L, first, j - first + 1);
    j = first;
  }
  order_.resize(chosen_positions.size());
  std::iota(order_.begin(), order_.end(), 0);
  const auto row_of = [&](int chosen) {
    return row_[static_cast<std::size_t>(chosen_positions[static_cast<std::size_t>(chosen)])];
  };
  std::sort(order_.begin(), order_.end(),
            [&](int a, int b) { return std::pair(row_of(a), a) < std::pair(row_of(b), b); });
  for (const int chosen : order_) chosen_row_.push_back(row_of(chosen));
}

void DenseInverse::read_block(const FactorView& L, int first, int width) {
  Block& block = blocks_.emplace_back();
  block.row = rows_;
  for (int c = 0; c < width; ++c) row_[static_cast<std::size_t>(first + c)] = rows_++;
  block_of_row_.resize(static_cast<std::size_t>(rows_), blocks_.size() - 1);

  const int* rows = L.row_index + L.column_start[first] + width;
  const int below = L.column_size[first] - width;
  for (int k = 0; k < below; ++k) block.below.push_back(row_[static_cast<std::size_t>(rows[k])]);
  Eigen::MatrixXd L11 = Eigen::MatrixXd::Zero(width, width);
  Eigen::MatrixXd L21(below, width);
  for (int c = 0; c < width; ++c) {
    const double* values = L.values + L.column_start[first + c];
    L11.col(c).tail(width - c) = Eigen::Map<const Eigen::VectorXd>(values, width - c);
    L21.col(c) = Eigen::Map<const Eigen::VectorXd>(values + width - c, below);
  }
  block.inverse = L11.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(width, width));
  block.below_left = L21 * block.inverse;
}

Eigen::MatrixXd DenseInverse::band(int first, int count) const {
  const auto begin = chosen_row_.begin() + first;
  const std::size_t last = block_of_row_[static_cast<std::size_t>(*(begin + count - 1))];
  const Block& deepest = blocks_[last];
  Rows Z = Rows::Zero(deepest.row + deepest.inverse.rows(), count);
  for (int k = 0; k < count; ++k) Z(*(begin + k), k) = 1.0;
  go_up(last, Z);
  go_down(last, Z);
  Eigen::MatrixXd chosen(first + count, count);
  for (int i = 0; i < first + count; ++i) chosen.row(i) = Z.row(chosen_row_[static_cast<std::size_t>(i)]);
  return chosen;
}

/// E becomes L₁₁⁻¹ of what L·Y = E leaves of it, block by block; blocks that nothing reaches stay zero.
void DenseInverse::go_up(std::size_t last, Rows& Y) const {
  std::vector<char> reached(last + 1, 0);
  for (std::size_t b = 0; b <= last; ++b) {
    const Block& block = blocks_[b];
    reached[b] = !Y.middleRows(block.row, block.inverse.rows()).isZero(0.0);
  }
  for (std::size_t b = last + 1; b-- > 0;) {
    if (!reached[b]) continue;
    const Block& block = blocks_[b];
    auto own = Y.middleRows(block.row, block.inverse.rows());
    const Rows passed_on = block.below_left * own;
    for (std::size_t k = 0; k < block.below.size(); ++k) {
      Y.row(block.below[k]) -= passed_on.row(static_cast<Index>(k));
      reached[block_of_row_[static_cast<std::size_t>(block.below[k])]] = 1;
    }
    own = block.inverse.triangularView<Eigen::Lower>() * Rows(own);
  }
}

/// Lᵀ·Z = Y from the root down.
void DenseInverse::go_down(std::size_t last, Rows& Z) const {
  Rows boundary;
  for (std::size_t b = 0; b <= last; ++b) {
    const Block& block = blocks_[b];
    auto own = Z.middleRows(block.row, block.inverse.rows());
    const Rows inside = block.inverse.transpose().triangularView<Eigen::Upper>() * Rows(own);
    own = inside;
    if (block.below.empty()) continue;
    boundary.resize(static_cast<Index>(block.below.size()), Z.cols());
    for (std::size_t k = 0; k < block.below.size(); ++k) boundary.row(static_cast<Index>(k)) = Z.row(block.below[k]);
    own.noalias() -= block.below_left.transpose() * boundary;
  }
}

}  // namespace helixnav::smoothing
