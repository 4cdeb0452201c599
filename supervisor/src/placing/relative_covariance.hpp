// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace helixnav::supervisor {

/// Covariance of each point relative to all: what is left of P (2n×2n) when the rigid motion that the points have in common
/// is taken out, P_rel = (I − QQᵀ) P (I − QQᵀ) with Q an orthonormal basis of their common motions. Zero for fewer than two
/// points. O(n²). Test: supervisor/placing/join_maps_test.cpp (common motion leaves nothing; independent errors stay).
std::vector<Eigen::Matrix2d> relative_covariances(const std::vector<Eigen::Vector2d>& points_m,
                                                  const Eigen::Ref<const Eigen::MatrixXd>& P);

}  // namespace helixnav::supervisor
