// SPDX-License-Identifier: BSD-3-Clause
#include "constants_fit.hpp"

#include <cmath>

#include <Eigen/Cholesky>

namespace helixnav::apps {
namespace {

std::vector<Eigen::Index> free_ones(const std::vector<bool>& free) {
  std::vector<Eigen::Index> columns;
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i]) columns.push_back(index(i));
  }
  return columns;
}

/// In units of what is known beforehand, plus a negligible amount, so that it can be inverted.
Eigen::VectorXd sigmas_alone(const Eigen::MatrixXd& information, const std::vector<Eigen::Index>& columns,
                             const Eigen::VectorXd& usual) {
  const Eigen::VectorXd units = usual(columns);
  Eigen::MatrixXd S = units.asDiagonal() * Eigen::MatrixXd(information(columns, columns)) * units.asDiagonal();
  S.diagonal().array() += 1e-6;
  const Eigen::MatrixXd covariance = S.ldlt().solve(Eigen::MatrixXd::Identity(S.rows(), S.cols()));
  return covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace

std::vector<bool> observable(const Eigen::MatrixXd& information, const Eigen::VectorXd& usual) {
  std::vector<bool> free(static_cast<std::size_t>(usual.size()), true);
  for (std::vector<Eigen::Index> columns = free_ones(free); !columns.empty(); columns = free_ones(free)) {
    Eigen::Index worst = 0;
    constexpr double half = 0.5;
    if (sigmas_alone(information, columns, usual).maxCoeff(&worst) < half) break;
    free[static_cast<std::size_t>(columns[static_cast<std::size_t>(worst)])] = false;
  }
  return free;
}

Eigen::VectorXd best_change(const smoothing::ConstantsEvidence& evidence, const std::vector<bool>& free,
                            const Eigen::VectorXd& pinned) {
  Eigen::VectorXd change = pinned;
  const std::vector<Eigen::Index> columns = free_ones(free);
  if (columns.empty()) return change;
  for (const Eigen::Index c : columns) change[c] = 0.0;
  const Eigen::VectorXd slope = evidence.gradient + evidence.information * change;
  const Eigen::VectorXd best =
      Eigen::MatrixXd(evidence.information(columns, columns)).ldlt().solve(Eigen::VectorXd(slope(columns)));
  for (std::size_t i = 0; i < columns.size(); ++i) change[columns[i]] = -best[index(i)];
  return change;
}

Eigen::VectorXd sigmas_of(const Eigen::MatrixXd& information, const std::vector<bool>& free,
                          const Eigen::VectorXd& usual) {
  Eigen::MatrixXd S = usual.asDiagonal() * information * usual.asDiagonal();
  for (std::size_t i = 0; i < free.size(); ++i) S(index(i), index(i)) += free[i] ? 1e-12 : 1.0;
  const Eigen::MatrixXd covariance = S.ldlt().solve(Eigen::MatrixXd::Identity(S.rows(), S.cols()));
  return usual.cwiseProduct(covariance.diagonal().cwiseMax(0.0).cwiseSqrt());
}

double chi2_change(const smoothing::ConstantsEvidence& evidence, const Eigen::VectorXd& change) {
  return 2.0 * evidence.gradient.dot(change) + change.dot(evidence.information * change);
}

double held_out_chi2(const std::vector<Fold>& folds, const std::vector<bool>& free, const Eigen::VectorXd& pinned) {
  double chi2 = 0.0;
  for (const Fold& fold : folds) chi2 += chi2_change(fold.held_out, best_change(fold.rest, free, pinned));
  return chi2;
}

std::vector<bool> confirmed(const std::vector<Fold>& folds, std::vector<bool> free, const Eigen::VectorXd& pinned) {
  while (true) {
    double best = held_out_chi2(folds, free, pinned);
    std::size_t worst = free.size();
    for (std::size_t i = 0; i < free.size(); ++i) {
      if (!free[i]) continue;
      std::vector<bool> without = free;
      without[i] = false;
      const double chi2 = held_out_chi2(folds, without, pinned);
      if (chi2 > best) continue;
      best = chi2;
      worst = i;
    }
    if (worst == free.size()) return free;
    free[worst] = false;
  }
}

}  // namespace helixnav::apps
