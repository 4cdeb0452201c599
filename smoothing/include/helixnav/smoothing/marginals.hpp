// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing {

/// Marginal covariances in the order asked for; poses in (x, y, heading) [m, m, rad], zero for fixed ones.
struct MarginalCovariances {
  std::vector<Eigen::Matrix3d> poses;
  std::vector<Eigen::Matrix2d> landmarks;
};

/// Blocks of H⁻¹ at the present values, for the poses and landmarks given by index. Takahashi's recursion: H⁻¹ on the
/// pattern of L, from the root of the elimination tree down, and only along the paths from the chosen variables to the
/// root; no dense inverse. Cost for all variables about that of a factorisation.
/// Errors as optimize(). Test: smoothing/marginals_test.cpp (dense inverse, 1e-9).
MarginalCovariances marginal_covariances(const Problem& problem, const std::vector<int>& poses,
                                         const std::vector<int>& landmarks);

/// The same for every landmark.
std::vector<Eigen::Matrix2d> landmark_covariances(const Problem& problem);

/// The joint covariance of the chosen poses and landmarks, (3p+2n)×(3p+2n) in the order given, poses first. The same
/// recursion with dense blocks for all pairs: at most 2·nnz(L)·(3p+2n) flops, 8·(3p+2n)² bytes in addition to the
/// result, somewhat more for poses on the paths from landmarks to the root. Errors as optimize().
/// Test: smoothing/marginals_test.cpp.
Eigen::MatrixXd joint_covariance(const Problem& problem, const std::vector<int>& poses,
                                 const std::vector<int>& landmarks);

}  // namespace helixnav::smoothing
