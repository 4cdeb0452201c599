// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "helixnav/association/innovation_problem.hpp"

namespace helixnav::association {

/// What each pair of a set adds to its joint NIS while pairs are removed one after another: the NIS with all minus the NIS
/// without that one, rᵢᵀ(S⁻¹)ᵢᵢ⁻¹rᵢ with r = S⁻¹ν. S⁻¹ is found once, O(n³); removing a pair is a rank-two change, O(n²).
/// Test: association/joint_innovation_test.cpp (leave one out, several in a row).
class JointShares {
 public:
  /// NumericalError, naming the landmarks, when the joint covariance is not positive definite.
  JointShares(const InnovationProblem& problem, const std::vector<int>& pairs);

  /// Of a pair by its place in the list, 0 once it is out.
  double of(std::size_t index) const { return shares_[index]; }
  /// The pair with the largest.
  std::size_t worst() const;
  /// Takes a pair out; returns its share, by which the NIS of the rest is smaller.
  double drop(std::size_t index);

 private:
  void find_shares();

  Eigen::MatrixXd S_inverse_;  // rows and columns of pairs that are out are zero
  Eigen::VectorXd r_;
  std::vector<char> is_out_;
  std::vector<double> shares_;
};

}  // namespace helixnav::association
