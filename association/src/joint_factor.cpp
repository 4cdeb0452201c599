// SPDX-License-Identifier: BSD-3-Clause
#include "joint_factor.hpp"

#include <cmath>

#include "helixnav/association/joint_innovation.hpp"
#include "not_positive_definite.hpp"

namespace helixnav::association {

JointFactor::JointFactor(const InnovationProblem& problem, std::size_t most_pairs)
    : problem_(problem), slot_of_prediction_(problem.predictions.size(), -1) {
  pairs_.reserve(most_pairs);
  rows_.resize((most_pairs + 1) * (most_pairs + 2) / 2);
  whitened_.resize(most_pairs + 1);
  std::vector<int> pair_of_slot;
  for (std::size_t p = 0; p < problem.pairs.size(); ++p) {
    int& slot = slot_of_prediction_[problem.pairs[p].prediction];
    if (slot >= 0) continue;
    slot = static_cast<int>(pair_of_slot.size());
    pair_of_slot.push_back(static_cast<int>(p));
  }
  slots_ = static_cast<int>(pair_of_slot.size());
  covariance_.resize(static_cast<std::size_t>(slots_) * slots_);
  for (int a = 0; a < slots_; ++a) {
    for (int b = 0; b < a; ++b) {
      // Between different observations: the noise of one has no part in it.
      GatedPair pair_a = problem.pairs[pair_of_slot[a]];
      GatedPair pair_b = problem.pairs[pair_of_slot[b]];
      pair_a.observation = 0;
      pair_b.observation = 1;
      covariance_[a * slots_ + b] = innovation_cross_covariance(problem, pair_a, pair_b);
      covariance_[b * slots_ + a] = covariance_[a * slots_ + b].transpose();
    }
  }
}

Increment JointFactor::weigh(int p) {
  const GatedPair& pair = problem_.pairs[p];
  const std::size_t n = pairs_.size();
  Eigen::Matrix2d* last = row(n);
  const Eigen::Matrix2d* covariance = covariance_.data() + slot_of_prediction_[pair.prediction] * slots_;
  Eigen::Matrix2d D = pair.S;
  Eigen::Vector2d e = pair.nu;
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Matrix2d* row_k = row(k);
    Eigen::Matrix2d C = covariance[slot_of_prediction_[problem_.pairs[pairs_[k]].prediction]];
    for (std::size_t l = 0; l < k; ++l) C.noalias() -= last[l] * row_k[l].transpose();
    const Eigen::Matrix2d& L = row_k[k];
    C.col(0) /= L(0, 0);
    C.col(1) = (C.col(1) - C.col(0) * L(1, 0)) / L(1, 1);
    last[k] = C;
    D.noalias() -= C * C.transpose();
    e.noalias() -= C * whitened_[k];
  }
  const double l00 = std::sqrt(D(0, 0));
  const double l10 = D(1, 0) / l00;
  const double l11 = std::sqrt(D(1, 1) - l10 * l10);
  if (!(l00 > 0.0) || !(l11 > 0.0)) throw_with(p);
  last[n] << l00, 0.0, l10, l11;
  whitened_[n] << e[0] / l00, (e[1] - l10 * e[0] / l00) / l11;
  return {whitened_[n].squaredNorm(), 2.0 * std::log(l00 * l11)};
}

void JointFactor::throw_with(int pair) const {
  std::vector<int> pairs = pairs_;
  pairs.push_back(pair);
  throw_not_positive_definite(problem_, pairs);
}

}  // namespace helixnav::association
