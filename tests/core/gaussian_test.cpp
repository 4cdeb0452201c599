// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/gaussian.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

#include "helixnav/core/mirror_lower.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::core {
namespace {

/// Q·diag(eigenvalues)·Qᵀ with a random orthogonal Q.
Eigen::MatrixXd with_eigenvalues(const Eigen::VectorXd& eigenvalues, RandomStream& random) {
  const Eigen::Index n = eigenvalues.size();
  Eigen::MatrixXd A(n, n);
  for (double& a : A.reshaped()) a = random.normal();
  const Eigen::MatrixXd Q = A.householderQr().householderQ();
  const Eigen::MatrixXd M = Q * eigenvalues.asDiagonal() * Q.transpose();
  return 0.5 * (M + M.transpose());
}

TEST(Asymmetry, IsTheLargestDifferenceAcrossTheDiagonal) {
  core::RandomStream random(5, "asymmetry");
  for (const Eigen::Index n : {1, 2, 63, 64, 65, 130}) {
    Eigen::MatrixXd M(n, n);
    for (Eigen::Index i = 0; i < n * n; ++i) M(i) = random.normal(0.0, 1.0);
    EXPECT_EQ(asymmetry(M), (M - M.transpose()).cwiseAbs().maxCoeff()) << n;
  }
  EXPECT_EQ(asymmetry(Eigen::MatrixXd()), 0.0);
}

TEST(MirrorLower, MakesTheUpperTriangleThatBelow) {
  core::RandomStream random(6, "mirror");
  for (const Eigen::Index n : {0, 1, 2, 63, 64, 65, 130}) {
    Eigen::MatrixXd M(n, n);
    for (double& m : M.reshaped()) m = random.normal();
    const Eigen::MatrixXd expected = M.selfadjointView<Eigen::Lower>();
    mirror_lower(M);
    EXPECT_EQ(M, expected) << n;
  }
}

TEST(PositiveDefinite, IsDecidedByTheSmallestEigenvalue) {
  RandomStream random(1, "gaussian");
  for (const Eigen::Index n : {1, 2, 3, 8, 40}) {
    Eigen::VectorXd eigenvalues = Eigen::VectorXd::LinSpaced(n, 1.0, 10.0);
    for (const double smallest : {1.0, 1e-3, 1e-6}) {
      eigenvalues[0] = smallest;
      EXPECT_TRUE(is_symmetric_positive_definite(with_eigenvalues(eigenvalues, random))) << n << " " << smallest;
      EXPECT_TRUE(is_symmetric_positive_semidefinite(with_eigenvalues(eigenvalues, random))) << n << " " << smallest;
      eigenvalues[0] = -smallest;
      EXPECT_FALSE(is_symmetric_positive_definite(with_eigenvalues(eigenvalues, random))) << n << " " << smallest;
      EXPECT_FALSE(is_symmetric_positive_semidefinite(with_eigenvalues(eigenvalues, random))) << n << " " << smallest;
    }
  }
}

TEST(PositiveSemidefinite, AcceptsSingularMatricesAndRoundOff) {
  RandomStream random(2, "gaussian");
  EXPECT_TRUE(is_symmetric_positive_semidefinite(Eigen::Matrix3d::Zero()));
  EXPECT_TRUE(is_symmetric_positive_semidefinite(with_eigenvalues(Eigen::Vector3d(0.0, 0.0, 5.0), random)));
  EXPECT_TRUE(is_symmetric_positive_semidefinite(with_eigenvalues(Eigen::Vector3d(-1e-11, 1.0, 5.0), random)));
  EXPECT_FALSE(is_symmetric_positive_definite(Eigen::Matrix3d::Zero()));
}

TEST(PositiveDefinite, IsIndependentOfUnits) {
  RandomStream random(3, "gaussian");
  const Eigen::MatrixXd M = with_eigenvalues(Eigen::Vector3d(1.0, 2.0, 3.0), random);
  for (const double scale : {1e-12, 1e12}) {
    EXPECT_TRUE(is_symmetric_positive_definite(scale * M));
    EXPECT_TRUE(is_symmetric_positive_semidefinite(scale * M));
    EXPECT_FALSE(is_symmetric_positive_semidefinite(-scale * M));
  }
}

TEST(PositiveDefinite, RefusesWhatIsNotSymmetricNotSquareOrNotFinite) {
  Eigen::MatrixXd M = Eigen::Matrix3d::Identity();
  M(0, 2) = 1e-6;
  EXPECT_FALSE(is_symmetric_positive_definite(M));
  EXPECT_FALSE(is_symmetric_positive_semidefinite(M));
  M(0, 2) = 1e-10;  // round-off
  EXPECT_TRUE(is_symmetric_positive_definite(M));
  EXPECT_FALSE(is_symmetric_positive_definite(Eigen::MatrixXd::Identity(2, 3)));
  EXPECT_FALSE(is_symmetric_positive_semidefinite(Eigen::MatrixXd::Identity(2, 3)));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    M = Eigen::Matrix3d::Identity();
    M(1, 1) = bad;
    EXPECT_FALSE(is_symmetric_positive_definite(M));
    EXPECT_FALSE(is_symmetric_positive_semidefinite(M));
  }
}

TEST(PositiveDefinite, IsNothingWhoseRootOverflows) {
  Eigen::Matrix3d C = Eigen::Vector3d(9e-5, 4e-5, 2e-4).asDiagonal();
  C(1, 2) = C(2, 1) = 1e308;
  EXPECT_FALSE(is_symmetric_positive_definite(C));
  EXPECT_FALSE(is_symmetric_positive_semidefinite(C));
}

}  // namespace
}  // namespace helixnav::core
