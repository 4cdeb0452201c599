// SPDX-License-Identifier: BSD-3-Clause
#include "solve/partial_cholesky.hpp"

#include <algorithm>

#include "helixnav/core/packed_product.hpp"
#include "helixnav/core/wide_cholesky.hpp"

namespace helixnav::atlas {
namespace {

constexpr Eigen::Index solved_at_once = 32;  ///< rows

}  // namespace

bool partial_cholesky(Square F, Eigen::Index ne) { return core::eliminate_first(F, ne); }

void solve_down_columns(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& L, Eigen::MatrixXd& F) {
  const Eigen::Index ne = L.cols();
  for (Eigen::Index first = 0; first < ne; first += solved_at_once) {
    const Eigen::Index count = std::min(solved_at_once, ne - first);
    const Eigen::Index below = L.rows() - first - count;
    auto solved = F.middleRows(first, count);
    L.block(first, first, count, count).triangularView<Eigen::Lower>().solveInPlace(solved);
    if (below == 0) continue;
    core::add_product(&F(first + count, 0), F.outerStride(),
                      core::Panels(L.block(first + count, first, below, count), core::left_width),
                      core::Panels::of_transposed(solved, core::right_width, -1.0));
  }
}

void add_gram(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& Y, double* P, Eigen::Index stride) {
  constexpr Eigen::Index at_once = 128;  // the packed copy of this many rows fits in the first-level cache
  for (Eigen::Index first = 0; first < Y.rows(); first += at_once) {
    const auto some = Y.middleRows(first, std::min(at_once, Y.rows() - first));
    core::add_product_lower(P, stride, core::Panels::of_transposed(some, core::left_width),
                            core::Panels::of_transposed(some, core::right_width));
  }
}

}  // namespace helixnav::atlas
