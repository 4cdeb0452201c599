// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/wide_cholesky.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "helixnav/core/packed_product.hpp"

namespace helixnav::core {
namespace {

using Eigen::Index;
using Square = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

constexpr Index at_once = 64;  ///< columns eliminated before the rest is updated with them

/// Lower triangle of F −= A·Aᵀ. What the products write beyond the last row of a column would belong to the next column, or to nobody:
/// the last rows go through a buffer.
void subtract_square(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& A, Square F) {
  constexpr Index rows_at_once = 128;
  const Panels right(-A, right_width);
  Eigen::MatrixXd buffer;
  for (Index first = 0; first < F.rows(); first += rows_at_once) {
    const Index rows = std::min(rows_at_once, F.rows() - first);
    const Index columns = first + rows;
    const Panels left(A.middleRows(first, rows), left_width);
    buffer.setZero((rows + 7) / 8 * 8, columns);
    add_product(buffer.data(), buffer.outerStride(), left, right, columns);
    F.block(first, 0, rows, first) += buffer.topLeftCorner(rows, first);
    F.block(first, first, rows, rows).triangularView<Eigen::Lower>() += buffer.block(0, first, rows, rows);
  }
}

}  // namespace

bool eliminate_first(Square F, Index count) {
  for (Index first = 0; first < count; first += at_once) {
    const Index columns = std::min(at_once, count - first);
    const Index below = F.rows() - first - columns;
    Square D = F.block(first, first, columns, columns);
    const Eigen::LLT<Square> llt(D);
    if (llt.info() != Eigen::Success) return false;
    if (below == 0) break;
    auto L = F.block(first + columns, first, below, columns);
    D.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(L);
    subtract_square(L, F.bottomRightCorner(below, below));
  }
  return true;
}

}  // namespace helixnav::core
