// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/conservative_bound.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::pf_relocalize {
namespace {

using Eigen::MatrixXd;

/// Random covariances of 2 to 5 points: full rank and rank deficient, variances over six decades, common errors.
MatrixXd random_covariance(core::RandomStream& random) {
  const auto n = static_cast<Eigen::Index>(2 + random.below(4));
  const auto columns = static_cast<Eigen::Index>(1 + random.below(static_cast<std::uint64_t>(2 * n) + 2));
  MatrixXd X(2 * n, columns);
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    const double scale = std::pow(10.0, random.uniform(-1.5, 1.5) * static_cast<double>(random.below(2)));
    for (Eigen::Index j = 0; j < columns; ++j) X(i, j) = scale * random.normal();
  }
  if (random.bernoulli(0.2)) X.topRows<2>().setZero();  // an exact base
  return X * X.transpose();
}

/// Smallest eigenvalue of bound − P, relative to ‖P‖.
double slack(const MatrixXd& bound, const MatrixXd& P) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(bound - P, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues().minCoeff() / P.norm();
}

double worst_slack(int runs, const std::function<MatrixXd(const MatrixXd&)>& rule) {
  core::RandomStream random(7, "bounds");
  double worst = HUGE_VAL;
  for (int run = 0; run < runs; ++run) {
    const MatrixXd P = random_covariance(random);
    worst = std::min(worst, slack(rule(P), P));
  }
  return worst;
}

double log_volume(const Blocks& blocks) {
  double sum = 0.0;
  for (const Eigen::Matrix2d& D : blocks) sum += std::log(D.determinant());
  return sum;
}

/// Landmarks of a relative map: a few common errors over independent ones, as in THEORY §2's table.
MatrixXd map_covariance(int landmarks, core::RandomStream& random) {
  MatrixXd P = 0.0025 * MatrixXd::Identity(2 * landmarks, 2 * landmarks);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < landmarks; ++i) points.emplace_back(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0));
  for (int source = 0; source < 6; ++source) {
    const Eigen::Vector2d centre(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0));
    MatrixXd B(2 * landmarks, 3);
    for (int i = 0; i < landmarks; ++i) {
      const Eigen::Vector2d d = points[static_cast<std::size_t>(i)] - centre;
      const double near = std::exp(-d.squaredNorm() / 450.0);
      B.middleRows<2>(2 * i) << 0.05 * near, 0.0, -0.004 * near * d.y(), 0.0, 0.05 * near, 0.004 * near * d.x();
    }
    P += B * B.transpose();
  }
  return P;
}

TEST(ConservativeBound, ScalarIsNeverBelowTheCovarianceInTenThousand) {
  EXPECT_GE(worst_slack(10000, [](const MatrixXd& P) { return block_diagonal(scalar_bound(P)); }), -1e-9);
}

TEST(ConservativeBound, TraceOptimalIsNeverBelowTheCovarianceInTenThousand) {
  EXPECT_GE(worst_slack(10000, [](const MatrixXd& P) { return block_diagonal(trace_bound(P)); }), -1e-9);
}

TEST(ConservativeBound, WhitenedAndTightenedIsNeverBelowTheCovarianceInTenThousand) {
  EXPECT_GE(worst_slack(10000, [](const MatrixXd& P) { return block_diagonal(whitened_bound(P, 2)); }), -1e-9);
}

TEST(ConservativeBound, LatentModesAndTheirResidualAreNeverBelowTheCovarianceInTenThousand) {
  EXPECT_GE(worst_slack(10000,
                        [](const MatrixXd& P) {
                          const LatentBound bound = latent_bound(P, 2, 1);
                          return MatrixXd(bound.V * bound.V.transpose() + block_diagonal(bound.residual));
                        }),
            -1e-9);
}

TEST(ConservativeBound, ElementwiseRulesThatLookRightAreNotBounds) {
  const auto violations = [](const std::function<Eigen::Matrix2d(const Eigen::Matrix2d&)>& addition) {
    core::RandomStream random(3, "wrong bounds");
    int count = 0;
    for (int run = 0; run < 2000; ++run) {
      MatrixXd X(6, 8);
      for (Eigen::Index k = 0; k < X.size(); ++k) X.data()[k] = random.normal();
      const MatrixXd P = X * X.transpose();
      Blocks D = diagonal_blocks(P);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          if (i != j) D[static_cast<std::size_t>(i)] += addition(P.block<2, 2>(2 * i, 2 * j));
        }
      }
      if (slack(block_diagonal(D), P) < -1e-9) ++count;
    }
    return count;
  };
  EXPECT_GT(violations([](const Eigen::Matrix2d& C) { return Eigen::Matrix2d(C.cwiseAbs()); }), 1900);
  EXPECT_GT(violations([](const Eigen::Matrix2d& C) {
              return Eigen::Matrix2d(C.cwiseAbs().maxCoeff() * Eigen::Matrix2d::Identity());
            }),
            1000);
}

TEST(ConservativeBound, PlainMarginalsAreNotABound) {
  core::RandomStream random(5, "marginals");
  const MatrixXd P = map_covariance(8, random);
  EXPECT_LT(slack(block_diagonal(diagonal_blocks(P)), P), -0.05);
}

TEST(ConservativeBound, WhitenedIsNeverLooserThanScalarInLogDet) {
  core::RandomStream random(11, "looser");
  for (int run = 0; run < 20; ++run) {
    const MatrixXd P = map_covariance(6 + run % 7, random);
    EXPECT_LE(log_volume(whitened_bound(P, 3)), log_volume(scalar_bound(P)) + 1e-9);
  }
}

TEST(ConservativeBound, TraceOptimalHasTheLeastTraceOfThePairRules) {
  core::RandomStream random(13, "trace");
  for (int run = 0; run < 20; ++run) {
    const MatrixXd P = map_covariance(8, random);
    EXPECT_LE(block_diagonal(trace_bound(P)).trace(), block_diagonal(scalar_bound(P)).trace() + 1e-12);
  }
}

TEST(ConservativeBound, SixLatentModesOf24LandmarksInflateTheTraceByLessThanOneAndAHalf) {
  core::RandomStream random(17, "latent");
  double inflation = 0.0, whitened = 0.0;
  for (int run = 0; run < 3; ++run) {
    const MatrixXd P = map_covariance(24, random);
    const LatentBound bound = latent_bound(P, 6, 2);
    inflation += (bound.V.squaredNorm() + block_diagonal(bound.residual).trace()) / P.trace() / 3.0;
    whitened += block_diagonal(whitened_bound(P, 1)).trace() / P.trace() / 3.0;
  }
  EXPECT_LT(inflation, 1.5);
  EXPECT_GT(inflation, 1.0);
  EXPECT_GT(whitened, 4.0);  // what a bound over a whole region costs
}

TEST(ConservativeBound, RegressionOfLatentModesGivesAJointCovariance) {
  core::RandomStream random(19, "regression");
  const MatrixXd P = map_covariance(5, random);
  const LatentBound bound = latent_bound(P, 3);
  MatrixXd joint(13, 13);  // (map, ξ): Cov(map, ξ) = P·regression must be V, and the whole positive semidefinite
  joint << P, P * bound.regression, (P * bound.regression).transpose(), MatrixXd::Identity(3, 3);
  EXPECT_LT((P * bound.regression - bound.V).norm(), 1e-9 * P.norm());
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<MatrixXd>(joint).eigenvalues().minCoeff(), -1e-9);
}

TEST(ConservativeBound, ConstellationsHoldEachPointOnceAndAtMostEight) {
  core::RandomStream random(23, "groups");
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 61; ++i) points.emplace_back(random.uniform(0.0, 100.0), random.uniform(0.0, 30.0));
  std::vector<int> seen;
  for (const std::vector<int>& group : constellations(points, 8)) {
    EXPECT_LE(group.size(), 8U);
    seen.insert(seen.end(), group.begin(), group.end());
  }
  std::sort(seen.begin(), seen.end());
  ASSERT_EQ(seen.size(), points.size());
  for (int i = 0; i < 61; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], i);
}

TEST(ConservativeBound, ConstellationsBoundTheMarginalOfEveryGroup) {
  core::RandomStream random(29, "group bounds");
  const MatrixXd P = map_covariance(12, random);
  const std::vector<std::vector<int>> groups{{0, 3, 5, 7}, {1, 2, 4, 6, 8}, {9, 10, 11}};
  const MatrixXd bound = block_diagonal(constellation_bound(P, groups));
  for (const std::vector<int>& group : groups) {
    std::vector<Eigen::Index> rows;
    for (const int i : group) rows.insert(rows.end(), {2 * i, 2 * i + 1});
    EXPECT_GE(slack(bound(rows, rows), P(rows, rows)), -1e-9);
  }
}

TEST(ConservativeBound, RefusesAnOddNumberOfRows) {
  EXPECT_THROW(scalar_bound(MatrixXd::Identity(3, 3)), core::PreconditionError);
  EXPECT_THROW(latent_bound(MatrixXd::Identity(4, 4), 5), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::pf_relocalize
