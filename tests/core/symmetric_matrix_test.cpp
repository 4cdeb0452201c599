// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/symmetric_matrix.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace helixnav::core {
namespace {

TEST(SymmetricMatrix, GivesBackWhatWasPutAway) {
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(7, 4);
  Eigen::MatrixXd A = root * root.transpose();
  A.triangularView<Eigen::StrictlyUpper>() = A.transpose();
  const SymmetricMatrix kept = A;
  EXPECT_EQ(kept.rows(), 7);
  EXPECT_EQ(kept.full(), A);
}

TEST(SymmetricMatrix, TakesTheLowerTriangleOfAnythingSquare) {
  Eigen::Matrix2d A;
  A << 1.0, 9.0, 2.0, 3.0;
  const Eigen::MatrixXd expected = (Eigen::Matrix2d() << 1.0, 2.0, 2.0, 3.0).finished();
  EXPECT_EQ(SymmetricMatrix(A).full(), expected);
  EXPECT_EQ(SymmetricMatrix(A.selfadjointView<Eigen::Lower>()).full(), expected);
  EXPECT_EQ(SymmetricMatrix(Eigen::Vector2d(1.0, 4.0).asDiagonal()).full(),
            Eigen::Vector2d(1.0, 4.0).asDiagonal().toDenseMatrix());
  EXPECT_EQ(SymmetricMatrix().rows(), 0);
}

TEST(SymmetricMatrix, KnowsWhetherItIsFinite) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  EXPECT_TRUE(SymmetricMatrix(A).all_finite());
  A(2, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(SymmetricMatrix(A).all_finite());
}

}  // namespace
}  // namespace helixnav::core
