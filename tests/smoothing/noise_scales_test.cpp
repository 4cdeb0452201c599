// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/noise_scales.hpp"

#include <gtest/gtest.h>

#include "dense_twin.hpp"
#include "helixnav/core/errors.hpp"
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

TEST(NoiseScales, HaveTheRedundanciesOfTheDenseProjector) {
  const Problem problem = solved(1);
  const Eigen::MatrixXd J = DenseTwin(problem).jacobian();
  const Eigen::MatrixXd M =
      Eigen::MatrixXd::Identity(J.rows(), J.rows()) - J * (J.transpose() * J).ldlt().solve(J.transpose());
  const auto odometry_rows = static_cast<Eigen::Index>(3 * problem.graph.pose_edges.size());
  const double odometry = M.diagonal().head(odometry_rows).sum();
  const double landmarks = M.diagonal().tail(M.rows() - odometry_rows).sum();
  constexpr int draws = 200;
  const NoiseScales scales = estimate_noise_scales(problem, 1, draws);
  // Each is a mean of 200 sums of squares: 5 standard deviations.
  EXPECT_NEAR(scales.odometry.redundancy, odometry, 5.0 * std::sqrt(2.0 * odometry / draws));
  EXPECT_NEAR(scales.landmarks.redundancy, landmarks, 5.0 * std::sqrt(2.0 * landmarks / draws));
}

TEST(NoiseScales, HoldTheTruthInTheirIntervals) {
  constexpr int runs = 60;
  int odometry = 0, landmarks = 0;
  for (int seed = 1; seed <= runs; ++seed) {
    const NoiseScales scales = estimate_noise_scales(solved(static_cast<std::uint64_t>(seed)), 1);
    odometry += scales.odometry.low_95 < 1.0 && 1.0 < scales.odometry.high_95 ? 1 : 0;
    landmarks += scales.landmarks.low_95 < 1.0 && 1.0 < scales.landmarks.high_95 ? 1 : 0;
  }
  // Of 60 at 95 %, fewer than 50 have a probability of 2e-4 at most.
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
