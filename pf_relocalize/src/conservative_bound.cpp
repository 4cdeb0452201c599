// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/conservative_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "helixnav/core/errors.hpp"

namespace helixnav::pf_relocalize {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using ConstRef = Eigen::Ref<const MatrixXd>;

int count(const ConstRef& P) { return static_cast<int>(P.rows()) / 2; }

Matrix2d block(const ConstRef& P, int i, int j) { return P.block<2, 2>(2 * i, 2 * j); }

/// A^½ and the pseudo-inverse A^-½ of a positive semidefinite block; directions without variance stay zero in both.
struct Root {
  Matrix2d half;
  Matrix2d inverse_half;
};

Root root(const Matrix2d& A) {
  Eigen::SelfAdjointEigenSolver<Matrix2d> eigen;
  eigen.computeDirect(A);
  const double floor = 1e-12 * std::max(eigen.eigenvalues()[1], 0.0);
  Eigen::Vector2d half, inverse;
  for (int k = 0; k < 2; ++k) {
    half[k] = std::sqrt(std::max(eigen.eigenvalues()[k], 0.0));
    inverse[k] = eigen.eigenvalues()[k] > floor ? 1.0 / half[k] : 0.0;
  }
  const Matrix2d& V = eigen.eigenvectors();
  return {V * half.asDiagonal() * V.transpose(), V * inverse.asDiagonal() * V.transpose()};
}

/// What one pair adds to its two blocks.
struct Addition {
  Matrix2d to_i;
  Matrix2d to_j;
};

Addition scalar_addition(const Matrix2d& C) {
  const Matrix2d magnitude = C.cwiseAbs();
  return {magnitude.rowwise().sum().asDiagonal(), magnitude.colwise().sum().asDiagonal()};
}

/// Least tr(W_i⁻¹ A) + tr(W_j⁻¹ B) over valid additions: SVD of the whitened cross block. A direction without variance
/// in W has none in C either, since P is positive semidefinite; round-off there is put back with plain |C|.
Addition whitened_addition(const Matrix2d& C, const Root& W_i, const Root& W_j) {
  const Matrix2d whitened = W_i.inverse_half * C * W_j.inverse_half;
  const Eigen::JacobiSVD<Matrix2d> svd(whitened, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix2d U = W_i.half * svd.matrixU(), V = W_j.half * svd.matrixV();
  const Eigen::Vector2d s = svd.singularValues();
  Addition addition{U * s.asDiagonal() * U.transpose(), V * s.asDiagonal() * V.transpose()};
  const double lost = (C - U * s.asDiagonal() * V.transpose()).cwiseAbs().sum();
  addition.to_i += lost * Matrix2d::Identity();
  addition.to_j += lost * Matrix2d::Identity();
  return addition;
}

/// log det of a block, with an absolute floor on the variances so that the exact bases of a map do not drown the rest.
double log_volume(const Matrix2d& D) { return std::log((D + 1e-12 * Matrix2d::Identity()).determinant()); }

double log_volume(const Blocks& blocks) {
  return std::accumulate(blocks.begin(), blocks.end(), 0.0,
                         [](double sum, const Matrix2d& D) { return sum + log_volume(D); });
}

/// A bound under construction: blocks D and what every pair added to them.
struct PairBound {
  Blocks D;
  std::vector<Addition> additions;  // [i·n + j], i < j
};

template <typename Rule>
PairBound bound_by_pairs(const ConstRef& P, const Rule& rule) {
  const int n = count(P);
  PairBound bound{diagonal_blocks(P), std::vector<Addition>(static_cast<std::size_t>(n) * static_cast<std::size_t>(n))};
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      const Addition addition = rule(i, j);
      bound.D[static_cast<std::size_t>(i)] += addition.to_i;
      bound.D[static_cast<std::size_t>(j)] += addition.to_j;
      bound.additions[static_cast<std::size_t>(i * n + j)] = addition;
    }
  }
  return bound;
}

/// One pair's addition made anew with the present blocks as weights, taken when it lowers log det.
void improve_pair(const ConstRef& P, int i, int j, PairBound& bound) {
  Matrix2d& D_i = bound.D[static_cast<std::size_t>(i)];
  Matrix2d& D_j = bound.D[static_cast<std::size_t>(j)];
  Addition& old = bound.additions[static_cast<std::size_t>(i * count(P) + j)];
  const Addition candidate = whitened_addition(block(P, i, j), root(D_i), root(D_j));
  const Matrix2d new_i = D_i - old.to_i + candidate.to_i, new_j = D_j - old.to_j + candidate.to_j;
  if (log_volume(new_i) + log_volume(new_j) >= log_volume(D_i) + log_volume(D_j)) return;
  D_i = new_i;
  D_j = new_j;
  old = candidate;
}

Blocks improve(const ConstRef& P, PairBound bound, int sweeps) {
  const int n = count(P);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) improve_pair(P, i, j, bound);
    }
  }
  return bound.D;
}

MatrixXd whitened_by(const Blocks& blocks, const ConstRef& P) {
  MatrixXd whitened = P;
  for (int i = 0; i < count(P); ++i) {
    const Matrix2d W = root(blocks[static_cast<std::size_t>(i)]).inverse_half;
    whitened.middleRows<2>(2 * i) = W * MatrixXd(whitened.middleRows<2>(2 * i));
    whitened.middleCols<2>(2 * i) = MatrixXd(whitened.middleCols<2>(2 * i)) * W;
  }
  return whitened;
}

/// The smallest t ≤ 1 with t·blkdiag(D) ⪰ P, a hair above it for round-off.
void tighten(const ConstRef& P, Blocks& blocks) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(whitened_by(blocks, P), Eigen::EigenvaluesOnly);
  const double scale = std::min(1.0, eigen.eigenvalues().maxCoeff() * (1.0 + 1e-12));
  for (Matrix2d& D : blocks) D *= scale;
}

void check(const ConstRef& P) {
  if (P.rows() != P.cols() || P.rows() % 2 != 0 || P.rows() == 0 || !P.allFinite()) {
    throw core::PreconditionError("conservative bound: the covariance must be 2n x 2n and finite");
  }
}

}  // namespace

Blocks diagonal_blocks(const ConstRef& P) {
  check(P);
  Blocks blocks;
  for (int i = 0; i < count(P); ++i) blocks.push_back(block(P, i, i));
  return blocks;
}

Eigen::MatrixXd block_diagonal(const Blocks& blocks) {
  const auto n = static_cast<Eigen::Index>(blocks.size());
  MatrixXd dense = MatrixXd::Zero(2 * n, 2 * n);
  for (Eigen::Index i = 0; i < n; ++i) dense.block<2, 2>(2 * i, 2 * i) = blocks[static_cast<std::size_t>(i)];
  return dense;
}

Blocks scalar_bound(const ConstRef& P) {
  check(P);
  return bound_by_pairs(P, [&](int i, int j) { return scalar_addition(block(P, i, j)); }).D;
}

Blocks trace_bound(const ConstRef& P) {
  check(P);
  const Root identity{Matrix2d::Identity(), Matrix2d::Identity()};
  return bound_by_pairs(P, [&](int i, int j) { return whitened_addition(block(P, i, j), identity, identity); }).D;
}

Blocks whitened_bound(const ConstRef& P, int sweeps) {
  check(P);
  std::vector<Root> roots;
  for (const Matrix2d& block_i : diagonal_blocks(P)) roots.push_back(root(block_i));
  const auto root_of = [&](int i) -> const Root& { return roots[static_cast<std::size_t>(i)]; };
  Blocks from_scalar =
      improve(P, bound_by_pairs(P, [&](int i, int j) { return scalar_addition(block(P, i, j)); }), sweeps);
  Blocks best = improve(
      P, bound_by_pairs(P, [&](int i, int j) { return whitened_addition(block(P, i, j), root_of(i), root_of(j)); }),
      sweeps);
  if (log_volume(from_scalar) < log_volume(best)) best = std::move(from_scalar);
  tighten(P, best);
  return best;
}

LatentBound latent_bound(const ConstRef& P, int modes, int sweeps) {
  const Blocks blocks = diagonal_blocks(P);
  if (modes < 0 || modes > P.rows()) throw core::PreconditionError("latent_bound: modes must lie in 0 … 2n");
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(whitened_by(blocks, P));
  const Eigen::VectorXd& lambda = eigen.eigenvalues();
  // The part of a strong mode above the bulk is common; the bulk itself is what independent errors look like.
  const double bulk = std::min(1.0, lambda[lambda.size() / 2]);
  MatrixXd V(P.rows(), modes), regression(P.rows(), modes);
  for (int k = 0; k < modes; ++k) {
    const Eigen::Index mode = lambda.size() - 1 - k;
    const double kept = std::sqrt(std::max(0.0, lambda[mode] - bulk));
    for (int i = 0; i < count(P); ++i) {
      const Root W = root(blocks[static_cast<std::size_t>(i)]);
      const Eigen::Vector2d u = eigen.eigenvectors().block<2, 1>(2 * i, mode);
      V.block<2, 1>(2 * i, k) = kept * (W.half * u);
      regression.block<2, 1>(2 * i, k) =
          kept > 0.0 ? Eigen::Vector2d(kept / lambda[mode] * (W.inverse_half * u)) : Eigen::Vector2d::Zero();
    }
  }
  const MatrixXd residual = P - V * V.transpose();
  return {V, regression, whitened_bound(residual, sweeps)};
}

}  // namespace helixnav::pf_relocalize
