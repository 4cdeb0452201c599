// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/association/innovation_problem.hpp"

namespace helixnav::association {

/// What one more pair adds to a joint innovation: to its NIS, and to the logarithm of its determinant.
struct Increment {
  double nis = 0.0;
  double log_determinant = 0.0;
};

/// Cholesky factor of the joint innovation covariance of a set of pairs that grows and shrinks at its end, for searches:
/// adding a pair costs O(n²) of 2×2 blocks, removing one nothing.
class JointFactor {
 public:
  /// Tabulates the covariances between all predictions that have a pair: O(n²) once.
  JointFactor(const InnovationProblem& problem, std::size_t most_pairs);

  /// The increment of a pair, without keeping it. NumericalError, naming the landmarks, when the joint covariance is not
  /// positive definite.
  Increment weigh(int pair);
  /// Keeps the pair last weighed.
  void keep(int pair) { pairs_.push_back(pair); }
  void drop() { pairs_.pop_back(); }
  void clear() { pairs_.clear(); }

  const std::vector<int>& pairs() const { return pairs_; }

 private:
  Eigen::Matrix2d* row(std::size_t index) { return rows_.data() + index * (index + 1) / 2; }
  [[noreturn]] void throw_with(int pair) const;

  const InnovationProblem& problem_;
  std::vector<int> slot_of_prediction_;
  int slots_ = 0;
  std::vector<Eigen::Matrix2d> covariance_;
  std::vector<int> pairs_;
  std::vector<Eigen::Matrix2d> rows_;      // lower triangle by rows
  std::vector<Eigen::Vector2d> whitened_;  // L⁻¹ν
};

}  // namespace helixnav::association
