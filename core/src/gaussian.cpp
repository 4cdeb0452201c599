// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/gaussian.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "helixnav/core/wide_cholesky.hpp"

namespace helixnav::core {
namespace {

constexpr double relative_tolerance = 1e-9;

bool is_symmetric_and_finite(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  if (matrix.rows() != matrix.cols() || !matrix.allFinite()) return false;
  if (matrix.rows() == 0) return true;
  const double scale = matrix.cwiseAbs().maxCoeff();
  return asymmetry(matrix) <= relative_tolerance * scale;
}

/// Eigen takes a NaN pivot, such as inf − inf gives, for a positive one.
bool has_root(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  const Eigen::LLT<Eigen::MatrixXd> llt(matrix);
  return llt.info() == Eigen::Success && llt.matrixLLT().allFinite();
}

}  // namespace

/// Tile by tile, because the elements of a row are far apart in memory.
double asymmetry(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  constexpr Eigen::Index tile = 64;
  const Eigen::Index n = matrix.rows();
  double largest = 0.0;
  for (Eigen::Index j = 0; j < n; j += tile) {
    for (Eigen::Index i = j; i < n; i += tile) {
      const Eigen::Index rows = std::min(tile, n - i), columns = std::min(tile, n - j);
      const auto difference = matrix.block(i, j, rows, columns) - matrix.block(j, i, columns, rows).transpose();
      largest = std::max(largest, difference.cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

bool is_symmetric_positive_definite(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  return is_symmetric_and_finite(matrix) && (matrix.rows() == 0 || has_root(matrix));
}

bool is_symmetric_positive_semidefinite(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  if (!is_symmetric_and_finite(matrix)) return false;
  if (matrix.rows() == 0) return true;
  const double shift = relative_tolerance * matrix.cwiseAbs().maxCoeff();
  if (shift == 0.0) return true;  // the zero matrix
  Eigen::MatrixXd shifted = matrix;
  shifted.diagonal().array() += shift;
  return eliminate_first(shifted, shifted.rows()) && shifted.allFinite();
}

}  // namespace helixnav::core
