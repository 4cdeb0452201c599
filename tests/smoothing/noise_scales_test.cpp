// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/noise_scales.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "dense_twin.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "random_problem.hpp"

namespace helixnav::smoothing {
namespace {

using testing::DenseTwin;
using testing::random_problem;
using testing::RandomProblem;

Problem solved(std::uint64_t seed) {
  RandomProblem made = random_problem(seed);
  made.problem.pose_priors.clear();
  made.problem.landmark_priors.clear();
  made.problem.graph.fix_edges.clear();
  if (made.problem.fixed_poses.empty()) made.problem.fixed_poses.push_back(0);
  optimize(made.problem);
  return made.problem;
}

/// S_ij = tr(P_i P_j) by the dense projector onto what the solution leaves of the measurements.
Eigen::Matrix2d dense_twin_of_s(const Problem& problem) {
  const Eigen::MatrixXd J = DenseTwin(problem).jacobian();
  const Eigen::MatrixXd P =
      Eigen::MatrixXd::Identity(J.rows(), J.rows()) - J * (J.transpose() * J).ldlt().solve(J.transpose());
  const auto n = static_cast<Eigen::Index>(3 * problem.graph.pose_edges.size());
  const Eigen::Index m = P.rows() - n;
  Eigen::Matrix2d S;
  S << P.topLeftCorner(n, n).squaredNorm(), P.topRightCorner(n, m).squaredNorm(),
      P.bottomLeftCorner(m, n).squaredNorm(), P.bottomRightCorner(m, m).squaredNorm();
  return S;
}

TEST(NoiseScales, HaveTheRedundanciesOfTheDenseProjector) {
  const Problem problem = solved(1);
  const Eigen::Vector2d redundancy = dense_twin_of_s(problem).rowwise().sum();
  const NoiseScales scales = estimate_noise_scales(problem, 1);  // however few are drawn
  EXPECT_NEAR(scales.odometry.redundancy, redundancy[0], 1e-5 * redundancy[0]);
  EXPECT_NEAR(scales.landmarks.redundancy, redundancy[1], 1e-5 * redundancy[1]);
}

TEST(NoiseScales, AreThoseOfTheDenseTwin) {
  const Problem problem = solved(3);
  const Eigen::Matrix2d S = dense_twin_of_s(problem);
  const Chi2 chi2 = evaluate_chi2(problem);
  const Eigen::Vector2d variances = S.inverse() * Eigen::Vector2d(chi2.odometry, chi2.landmarks);
  const Eigen::Matrix2d C = 2.0 * S.inverse();
  const NoiseScales scales = estimate_noise_scales(problem, 1, 3000);
  EXPECT_NEAR(scales.odometry.factor, std::sqrt(variances[0]), 0.005);
  EXPECT_NEAR(scales.landmarks.factor, std::sqrt(variances[1]), 0.005);
  EXPECT_NEAR(std::log(scales.odometry.high_95 / scales.odometry.factor), 0.98 * std::sqrt(C(0, 0)), 0.005);
  EXPECT_NEAR(std::log(scales.landmarks.high_95 / scales.landmarks.factor), 0.98 * std::sqrt(C(1, 1)), 0.005);
}

TEST(NoiseScales, HoldTheTruthInTheirIntervals) {
  constexpr int runs = 60;
  int odometry = 0, landmarks = 0;
  for (int seed = 1; seed <= runs; ++seed) {
    const NoiseScales scales = estimate_noise_scales(solved(static_cast<std::uint64_t>(seed)), 1);
    odometry += scales.odometry.low_95 < 1.0 && 1.0 < scales.odometry.high_95 ? 1 : 0;
    landmarks += scales.landmarks.low_95 < 1.0 && 1.0 < scales.landmarks.high_95 ? 1 : 0;
  }
  // Of 60 at 95 %, fewer than 50 has a probability of 2e-4 at most.
  EXPECT_GE(odometry, 50);
  EXPECT_GE(landmarks, 50);
}

TEST(NoiseScales, FollowCovariancesThatAreWrong) {
  Problem problem = solved(2);
  const NoiseScales right = estimate_noise_scales(problem, 1);
  for (auto& edge : problem.graph.pose_edges) edge.covariance *= 4.0;
  for (auto& edge : problem.graph.landmark_edges) edge.observation.R *= 4.0;
  const NoiseScales wrong = estimate_noise_scales(problem, 1);
  EXPECT_NEAR(wrong.odometry.factor, 0.5 * right.odometry.factor, 0.02);
  EXPECT_NEAR(wrong.landmarks.factor, 0.5 * right.landmarks.factor, 0.02);
}

TEST(NoiseScales, RefuseAProblemWithoutOneOfTheKinds) {
  EXPECT_THROW(estimate_noise_scales({}, 1), core::PreconditionError);
  EXPECT_THROW(estimate_noise_scales(solved(1), 1, 0), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::smoothing
