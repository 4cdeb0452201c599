// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/drifting_level.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/random.hpp"

namespace helixnav::apps {
namespace {

Eigen::VectorXd white(Eigen::Index n, core::RandomStream& random) {
  Eigen::VectorXd noise(n);
  for (Eigen::Index i = 0; i < n; ++i) noise[i] = random.normal();
  return noise;
}

bool is_constant(const Eigen::VectorXd& level) { return level.maxCoeff() - level.minCoeff() < 1e-9; }

// Of 400 series of noise 5 % drift asymptotically, fewer if short; more than 34 (8.5 %) has probability 0.2 %.
TEST(DriftingLevel, IsTheMeanOfWhiteNoise) {
  core::RandomStream random(1, "drifting level");
  int drifting = 0;
  constexpr int series = 400;
  for (int i = 0; i < series; ++i) {
    const Eigen::VectorXd seen = 3.0 + white(150, random).array();
    const Eigen::VectorXd level = drifting_level(seen, Eigen::VectorXd::Constant(149, 1.2));
    drifting += is_constant(level) ? 0 : 1;
    EXPECT_NEAR(level.mean(), seen.mean(), 1e-9);
  }
  EXPECT_LE(drifting, 34);
  EXPECT_GE(drifting, 4) << "1 %: never to drift would be no judgement";
}

TEST(DriftingLevel, FollowsWhatGoesBeyondTheNoise) {
  core::RandomStream random(2, "drifting level");
  constexpr Eigen::Index n = 200;
  Eigen::VectorXd truth(n);
  for (Eigen::Index i = 0; i < n; ++i) truth[i] = 5.0 * std::sin(0.2 * static_cast<double>(i));
  const Eigen::VectorXd level = drifting_level(truth + white(n, random), Eigen::VectorXd::Constant(n - 1, 1.0));
  const double error = std::sqrt((level - truth).squaredNorm() / static_cast<double>(n));
  EXPECT_LT(error, 0.9) << "nearer than what was seen";
  EXPECT_GT(level.dot(truth) / truth.squaredNorm(), 0.9);
}

/// The same with dense matrices.
Eigen::VectorXd dense_level(const Eigen::VectorXd& seen, const Eigen::VectorXd& apart_s) {
  const Eigen::Index n = apart_s.size();
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    D(i, i) = -1.0;
    D(i, i + 1) = 1.0;
  }
  const Eigen::VectorXd steps = D * seen;
  const auto covariance = [&](double ratio) {
    return Eigen::MatrixXd(D * D.transpose() + ratio * Eigen::MatrixXd(apart_s.asDiagonal()));
  };
  const auto log_likelihood = [&](double ratio) {
    const Eigen::MatrixXd M = covariance(ratio);
    return -0.5 * (static_cast<double>(n) * std::log(steps.dot(M.ldlt().solve(steps))) + std::log(M.determinant()));
  };
  double best = 0.0, least = log_likelihood(0.0) + 1.35;
  for (double ratio = 1e-8; ratio < 1e6; ratio *= 2.0) {
    if (log_likelihood(ratio) > least) {
      best = ratio;
      least = log_likelihood(ratio);
    }
  }
  return seen - D.transpose() * covariance(best).ldlt().solve(steps);
}

TEST(DriftingLevel, IsThatOfTheDenseEquations) {
  core::RandomStream random(3, "drifting level");
  for (const double drift : {0.0, 0.1, 1.0, 10.0}) {
    constexpr Eigen::Index n = 25;
    Eigen::VectorXd seen = white(n, random), apart_s(n - 1);
    double level = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      seen[i] += level;
      if (i + 1 < n) apart_s[i] = 0.5 + random.uniform();
      if (i + 1 < n) level += drift * std::sqrt(apart_s[i]) * random.normal();
    }
    EXPECT_LT((drifting_level(seen, apart_s) - dense_level(seen, apart_s)).norm(), 1e-9) << drift;
  }
}

TEST(DriftingLevel, LeavesWhatStandsAndWhatIsOne) {
  EXPECT_EQ(drifting_level(Eigen::VectorXd::Zero(5), Eigen::VectorXd::Ones(4)), Eigen::VectorXd::Zero(5));
  EXPECT_EQ(drifting_level(Eigen::VectorXd::Ones(1), Eigen::VectorXd()), Eigen::VectorXd::Ones(1));
  EXPECT_EQ(drifting_level(Eigen::VectorXd(), Eigen::VectorXd()).size(), 0);
}

}  // namespace
}  // namespace helixnav::apps
