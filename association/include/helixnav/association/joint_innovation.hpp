// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/association/innovation_problem.hpp"

namespace helixnav::association {

/// Covariance between the innovations of two pairs, 2×2 with padding: H_a P H_bᵀ, plus R when both are of the
/// same observation. Cost: about 40 multiplications. Test: association/joint_innovation_test.cpp (dense H P Hᵀ).
Eigen::Matrix2d innovation_cross_covariance(const InnovationProblem& problem, const GatedPair& a, const GatedPair& b);

/// Joint innovation of a set of pairs, with the covariance that results from the shared pose and the correlations of
/// the map. Two padded rows per pair, in the order given.
struct JointInnovation {
  Eigen::VectorXd nu;
  Eigen::MatrixXd S;
  int dof = 0;
};
JointInnovation joint_innovation(const InnovationProblem& problem, const std::vector<int>& pairs);

/// νᵀS⁻¹ν of a set of pairs with its degrees of freedom, and ln N(ν; 0, S).
struct JointNis {
  double nis = 0.0;
  int dof = 0;
  double log_likelihood = 0.0;
};

/// Cost O(n³) in the number of pairs, 8 µs for 15. Throws NumericalError, naming the landmarks, when the joint covariance
/// is not positive definite. Test: association/joint_innovation_test.cpp (dense inverse).
JointNis joint_nis(const InnovationProblem& problem, const std::vector<int>& pairs);

}  // namespace helixnav::association
