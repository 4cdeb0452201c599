// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/marginals.hpp"

#include <numeric>

#include "joint.hpp"
#include "sparse/selected_inverse.hpp"

namespace helixnav::smoothing {
namespace {

const Problem& checked(const Problem& problem) {
  check_problem(problem);
  return problem;
}

/// The problem with H factorised at its values.
struct FactorizedProblem {
  explicit FactorizedProblem(const Problem& problem) : session(checked(problem), options) {
    if (session.layout.columns == 0) return;
    session.linearize();
    session.factorize_undamped();
  }

  Options options;
  Session session;
};

/// Chosen variables of N coordinates each, `at` the position of each coordinate in the elimination order.
template <int N>
Eigen::Matrix<double, N, N> block(const SelectedInverse& inverse, const int* at) {
  Eigen::Matrix<double, N, N> covariance;
  for (int r = 0; r < N; ++r) {
    for (int c = r; c < N; ++c) covariance(r, c) = covariance(c, r) = inverse.at(at[r], at[c]);
  }
  return covariance;
}

}  // namespace

MarginalCovariances marginal_covariances(const Problem& problem, const std::vector<int>& poses,
                                         const std::vector<int>& landmarks) {
  const FactorizedProblem factorized(problem);
  const std::vector<int> position = positions(factorized.session);
  std::vector<int> chosen = columns_of(factorized.session, poses, landmarks);
  std::vector<int> free;
  for (int& column : chosen) {
    if (column < 0) continue;
    column = position[static_cast<std::size_t>(column)];
    free.push_back(column);
  }
  MarginalCovariances marginals;
  if (free.empty()) {
    marginals.poses.assign(poses.size(), Eigen::Matrix3d::Zero());
    return marginals;
  }
  const SelectedInverse inverse(factorized.session.cholesky.factor(), free);
  const int* at = chosen.data();
  for (std::size_t k = 0; k < poses.size(); ++k, at += 3) {
    marginals.poses.push_back(*at < 0 ? Eigen::Matrix3d::Zero() : block<3>(inverse, at));
  }
  for (std::size_t k = 0; k < landmarks.size(); ++k, at += 2) marginals.landmarks.push_back(block<2>(inverse, at));
  return marginals;
}

std::vector<Eigen::Matrix2d> landmark_covariances(const Problem& problem) {
  std::vector<int> all(problem.graph.landmarks.size());
  std::iota(all.begin(), all.end(), 0);
  return marginal_covariances(problem, {}, all).landmarks;
}

Eigen::MatrixXd joint_covariance(const Problem& problem, const std::vector<int>& poses,
                                 const std::vector<int>& landmarks) {
  return joint_covariance(FactorizedProblem(problem).session, poses, landmarks);
}

}  // namespace helixnav::smoothing
