// SPDX-License-Identifier: BSD-3-Clause
#include "drifting_level.hpp"

#include <cmath>

namespace helixnav::apps {
namespace {

/// The steps between the observed values, as measurements: their covariance is 2 and −1 beside the diagonal for the
/// noise, and ratio·apart on it for the drift, in units of the variance of the noise.
struct Steps {
  Eigen::VectorXd weighted;     ///< by the inverse of their covariance
  double log_likelihood = 0.0;  ///< with the best variance of the noise
};

/// By LDLᵀ of the tridiagonal covariance.
Steps judge_steps(const Eigen::VectorXd& steps, const Eigen::VectorXd& apart_s, double ratio) {
  const Eigen::Index n = steps.size();
  Eigen::VectorXd pivot(n);
  Steps result;
  result.weighted = steps;
  double log_determinant = 0.0, square_sum = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    pivot[i] = 2.0 + ratio * apart_s[i];
    if (i > 0) {
      pivot[i] -= 1.0 / pivot[i - 1];
      result.weighted[i] += result.weighted[i - 1] / pivot[i - 1];
    }
    log_determinant += std::log(pivot[i]);
    square_sum += result.weighted[i] * result.weighted[i] / pivot[i];
  }
  for (Eigen::Index i = n; i-- > 0;) {
    if (i + 1 < n) result.weighted[i] += result.weighted[i + 1];
    result.weighted[i] /= pivot[i];
  }
  result.log_likelihood = -0.5 * (static_cast<double>(n) * std::log(square_sum) + log_determinant);
  return result;
}

}  // namespace

Eigen::VectorXd drifting_level(const Eigen::VectorXd& seen, const Eigen::VectorXd& apart_s) {
  const Eigen::Index n = seen.size() - 1;
  if (n < 1) return seen;
  const Eigen::VectorXd steps = seen.tail(n) - seen.head(n);
  if (steps.isZero(0.0)) return seen;
  Steps best = judge_steps(steps, apart_s, 0.0);
  constexpr double evident = 1.35;  // half of the 90 % of χ² with one degree: without any drift one half is at zero
  double least = best.log_likelihood + evident;
  constexpr double smallest_ratio = 1e-8, largest_ratio = 1e6;  // 1/s
  for (double ratio = smallest_ratio; ratio < largest_ratio; ratio *= 2.0) {
    Steps trial = judge_steps(steps, apart_s, ratio);
    if (!(trial.log_likelihood > least)) continue;
    least = trial.log_likelihood;
    best = std::move(trial);
  }
  Eigen::VectorXd level = seen;
  level.tail(n) -= best.weighted;
  level.head(n) += best.weighted;
  return level;
}

}  // namespace helixnav::apps
