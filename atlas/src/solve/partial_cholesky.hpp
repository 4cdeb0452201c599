// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace helixnav::atlas {

/// A square matrix in a larger array, or a whole one.
using Square = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

/// Eliminates the first `ne` rows of a symmetric matrix given by its lower triangle, in place: L₁₁, L₂₁ = F₂₁L₁₁⁻ᵀ, and the Schur
/// complement F₂₂ − L₂₁L₂₁ᵀ. False when F₁₁ is not positive definite. The result does not depend on threads.
/// Test: atlas/joint_test.cpp.
bool partial_cholesky(Square F, Eigen::Index ne);

/// [Y; R] ← [L₁₁⁻¹Y; R − L₂₁L₁₁⁻¹Y] in the first rows of F, as many as L = [L₁₁; L₂₁] has, L₁₁ lower triangular. F has
/// at least `spare_rows` further rows, with finite values. Test: atlas/joint_test.cpp.
void solve_down_columns(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& L, Eigen::MatrixXd& F);
constexpr Eigen::Index spare_rows = 7;  ///< the products work on eight rows at a time

/// Lower triangle of P += YᵀY, P with this stride in a larger array that has `spare_rows` more rows; the upper one
/// is left with arbitrary values.
void add_gram(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& Y, double* P, Eigen::Index stride);

}  // namespace helixnav::atlas
