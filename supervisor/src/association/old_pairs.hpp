// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/association/innovation_problem.hpp"

namespace helixnav::supervisor {

/// Gated pairs with old landmarks, jointly: innovations and their covariance, all correlations included, given pairs that
/// are right wherever the vehicle is. Two padded rows per pair, as in association::JointInnovation.
struct OldPairs {
  const association::InnovationProblem* problem = nullptr;
  std::vector<int> pair;  ///< indices into problem->pairs, ascending
  Eigen::VectorXd nu;
  Eigen::MatrixXd S;

  int size() const { return static_cast<int>(pair.size()); }
  const association::GatedPair& at(int k) const {
    return problem->pairs[static_cast<std::size_t>(pair[static_cast<std::size_t>(k)])];
  }
  Eigen::Vector2d innovation(int k) const { return nu.segment<2>(2 * k); }
  Eigen::Matrix2d covariance(int k, int l) const { return S.block<2, 2>(2 * k, 2 * l); }
};

/// Cost O((n + g)²) for n pairs and g given. NumericalError if the covariance of the given ones is not positive definite.
OldPairs old_pairs_given(const association::InnovationProblem& problem, const std::vector<int>& pairs,
                         const std::vector<int>& given);

/// One way to match observations with old landmarks: positions in OldPairs, ascending, no observation and no landmark twice.
using Matching = std::vector<int>;

/// ln N(ν; 0, S) of the pairs of a matching together; −∞ if S is not positive definite.
double joint_log_likelihood(const OldPairs& old, const Matching& matching);

/// What two pairs lead to: given these two, every other observation takes the nearest old landmark within the 99 %
/// gate. Cost O(n log n).
Matching matching_given(const OldPairs& old, int first, int second);

}  // namespace helixnav::supervisor
