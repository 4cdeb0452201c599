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

/// B ← L⁻¹B, L lower triangular. Test: atlas/joint_test.cpp.
void solve_lower(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& L,
                 Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> B);

/// Lower triangle of P += YᵀY.
void add_gram(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& Y, Square P);

/// C −= A·B.
void subtract_product(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& A,
                      const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& B,
                      Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> C);

}  // namespace helixnav::atlas
