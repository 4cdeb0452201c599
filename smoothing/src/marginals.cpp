// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/marginals.hpp"

#include <numeric>

#include "helixnav/core/errors.hpp"
#include "selected_inverse.hpp"
#include "session.hpp"

namespace helixnav::smoothing {
namespace {

/// H factorised at the values of the problem, and who stands in which column.
class FactorizedProblem {
 public:
  explicit FactorizedProblem(const Problem& problem) : session_(checked(problem), options_) {
    if (session_.layout.columns == 0) return;
    session_.linearize();
    session_.factorize_undamped();
    position_.resize(static_cast<std::size_t>(session_.layout.columns));
    const FactorView L = session_.cholesky.factor();
    for (int k = 0; k < L.columns; ++k) position_[static_cast<std::size_t>(L.permutation[k])] = k;
  }

  int pose_column(int pose) const { return session_.layout.pose_column.at(static_cast<std::size_t>(pose)); }
  int landmark_column(int landmark) const {
    return session_.layout.landmark_column.at(static_cast<std::size_t>(landmark));
  }
  int position(int column) const { return position_[static_cast<std::size_t>(column)]; }
  int columns() const { return session_.layout.columns; }
  Cholesky& cholesky() { return session_.cholesky; }

 private:
  static const Problem& checked(const Problem& problem) {
    check_problem(problem);
    return problem;
  }

  Options options_;
  Session session_;
  std::vector<int> position_;
};

template <int N>
Eigen::Matrix<double, N, N> block(const FactorizedProblem& problem, const SelectedInverse& inverse, int column) {
  Eigen::Matrix<double, N, N> covariance;
  for (int r = 0; r < N; ++r) {
    for (int c = r; c < N; ++c) {
      covariance(r, c) = covariance(c, r) = inverse.at(problem.position(column + r), problem.position(column + c));
    }
  }
  return covariance;
}

void check_chosen(const std::vector<int>& chosen, std::size_t size, const char* what) {
  for (const int i : chosen) {
    if (i < 0 || static_cast<std::size_t>(i) >= size) {
      throw core::PreconditionError(std::string("smoothing: there is no ") + what + " with index " + std::to_string(i));
    }
  }
}

/// Columns of H that the chosen variables occupy, −1 for each coordinate of a fixed pose.
std::vector<int> columns_of(const FactorizedProblem& problem, const std::vector<int>& poses,
                            const std::vector<int>& landmarks) {
  std::vector<int> columns;
  for (const int pose : poses) {
    const int column = problem.pose_column(pose);
    for (int k = 0; k < 3; ++k) columns.push_back(column < 0 ? -1 : column + k);
  }
  for (const int landmark : landmarks) {
    for (int k = 0; k < 2; ++k) columns.push_back(problem.landmark_column(landmark) + k);
  }
  return columns;
}

}  // namespace

MarginalCovariances marginal_covariances(const Problem& problem, const std::vector<int>& poses,
                                         const std::vector<int>& landmarks) {
  check_chosen(poses, problem.graph.poses.size(), "pose");
  check_chosen(landmarks, problem.graph.landmarks.size(), "landmark");
  FactorizedProblem factorized(problem);
  std::vector<int> chosen;
  for (const int column : columns_of(factorized, poses, landmarks)) {
    if (column >= 0) chosen.push_back(factorized.position(column));
  }
  MarginalCovariances marginals;
  if (chosen.empty()) {
    marginals.poses.assign(poses.size(), Eigen::Matrix3d::Zero());
    return marginals;
  }
  const SelectedInverse inverse(factorized.cholesky().factor(), chosen);
  for (const int pose : poses) {
    const int column = factorized.pose_column(pose);
    marginals.poses.push_back(column < 0 ? Eigen::Matrix3d::Zero() : block<3>(factorized, inverse, column));
  }
  for (const int landmark : landmarks) {
    marginals.landmarks.push_back(block<2>(factorized, inverse, factorized.landmark_column(landmark)));
  }
  return marginals;
}

std::vector<Eigen::Matrix2d> landmark_covariances(const Problem& problem) {
  std::vector<int> all(problem.graph.landmarks.size());
  std::iota(all.begin(), all.end(), 0);
  return marginal_covariances(problem, {}, all).landmarks;
}

Eigen::MatrixXd joint_covariance(const Problem& problem, const std::vector<int>& poses,
                                 const std::vector<int>& landmarks) {
  check_chosen(poses, problem.graph.poses.size(), "pose");
  check_chosen(landmarks, problem.graph.landmarks.size(), "landmark");
  FactorizedProblem factorized(problem);
  const std::vector<int> columns = columns_of(factorized, poses, landmarks);
  const Eigen::Index n = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(factorized.columns());
  Eigen::VectorXd column_of_inverse;
  for (Eigen::Index c = 0; c < n; ++c) {
    const int column = columns[static_cast<std::size_t>(c)];
    if (column < 0) continue;
    unit[column] = 1.0;
    factorized.cholesky().solve(unit, column_of_inverse);
    unit[column] = 0.0;
    for (Eigen::Index r = 0; r < n; ++r) {
      const int row = columns[static_cast<std::size_t>(r)];
      if (row >= 0) covariance(r, c) = column_of_inverse[row];
    }
  }
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace helixnav::smoothing
