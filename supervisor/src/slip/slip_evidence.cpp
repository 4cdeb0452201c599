// SPDX-License-Identifier: BSD-3-Clause
#include "slip/slip_evidence.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/angle.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double impossible_nats = -1e9;
constexpr int most_rounds = 4;  // of the iteration to the likeliest δ, which settles in two

/// −½ (νᵀS⁻¹ν + ln |2πS|).
double log_normal(const Eigen::VectorXd& nu, const Eigen::VectorXd& weighed, const Eigen::LLT<Eigen::MatrixXd>& llt) {
  const double log_determinant = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
  return -0.5 * (nu.dot(weighed) + log_determinant + static_cast<double>(nu.size()) * std::log(2.0 * core::pi));
}

SlipExplanation explain_by(const SlipComponent& component, const RelativeGeometry& geometry,
                           const std::vector<SeenPoint>& seen, const std::vector<PointPair>& pairs, double nats_a_pair,
                           const Eigen::Vector3d& start) {
  SlipExplanation found;
  found.component = component;
  found.displacement = start;
  const Eigen::Matrix3d Q = component.covariance();
  for (int round = 0; round < most_rounds; ++round) {
    const PairEquations e(geometry, seen, pairs, found.displacement);
    const Eigen::MatrixXd AQ = e.A * Q;
    const Eigen::LLT<Eigen::MatrixXd> llt(e.S + AQ * e.A.transpose());
    found.nats = impossible_nats;
    if (llt.info() != Eigen::Success) return found;
    const Eigen::VectorXd weighed = llt.solve(e.nu);
    const Eigen::Vector3d better = AQ.transpose() * weighed;
    const bool settled = (better - found.displacement).norm() < 1e-3 * std::sqrt(Q.trace());
    found.displacement = better;
    found.displacement_covariance = Q - AQ.transpose() * llt.solve(AQ);
    found.nats = std::log(component.probability) + static_cast<double>(pairs.size()) * nats_a_pair +
                 log_normal(e.nu, weighed, llt);
    if (settled) break;
  }
  return found;
}

}  // namespace

std::vector<SlipComponent> slip_components(const SlipOptions& options) {
  constexpr double degree = core::pi / 180.0;
  return {{options.small_m, 1.5 * degree, 0.01},
          {options.middle_m, 4.0 * degree, 0.01},
          {options.large_m, 10.0 * degree, 0.001}};
}

double pair_nats(double detection_probability, double extraneous_per_m2) {
  return std::log(detection_probability / (1.0 - detection_probability)) - std::log(extraneous_per_m2);
}

SlipExplanation explain_by_slip(const RelativeGeometry& geometry, const std::vector<SeenPoint>& seen,
                                const std::vector<PointPair>& pairs, double nats_a_pair,
                                const std::vector<SlipComponent>& components, const Eigen::Vector3d& start) {
  SlipExplanation best;
  best.nats = impossible_nats;
  if (pairs.empty()) return best;
  for (const SlipComponent& component : components) {
    const SlipExplanation one = explain_by(component, geometry, seen, pairs, nats_a_pair, start);
    if (one.nats > best.nats) best = one;
  }
  return best;
}

double explain_without_slip(const RelativeGeometry& geometry, const std::vector<SeenPoint>& seen,
                            const std::vector<PointPair>& pairs, double nats_a_pair) {
  if (pairs.empty()) return 0.0;
  const PairEquations e(geometry, seen, pairs, Eigen::Vector3d::Zero());
  const Eigen::LLT<Eigen::MatrixXd> llt(e.S);
  if (llt.info() != Eigen::Success) return impossible_nats;
  return static_cast<double>(pairs.size()) * nats_a_pair + log_normal(e.nu, llt.solve(e.nu), llt);
}

}  // namespace helixnav::supervisor
