// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/constants_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace helixnav::apps {
namespace {

smoothing::ConstantsEvidence evidence(const Eigen::MatrixXd& information, const Eigen::VectorXd& minimum) {
  return {-information * minimum, information};
}

TEST(ConstantsFit, LeavesOutTheWorseOfTwoThatCannotBeToldApart) {
  Eigen::Matrix3d S;  // only the sum of the first two is observed; the third is observed by itself
  S << 100.0, 100.0, 0.0, 100.0, 100.0, 0.0, 0.0, 0.0, 1e4;
  const Eigen::Vector3d usual(1.0, 3.0, 0.5);
  const std::vector<bool> free = observable(S, usual);
  EXPECT_EQ(free[0] ? 1 : 0, free[1] ? 0 : 1) << "one of both is told";
  EXPECT_TRUE(free[2]);
  // The one that is held is as uncertain as usual, and so is the other.
  const Eigen::VectorXd sigmas = sigmas_of(S, free, usual);
  const double told = free[0] ? 3.0 : 1.0;
  EXPECT_NEAR(sigmas[free[0] ? 0 : 1], std::hypot(told, 0.1), 1e-6);
  EXPECT_NEAR(sigmas[2], 0.01, 1e-9);
}

TEST(ConstantsFit, FindsNothingWhereThereIsNoEvidence) {
  const std::vector<bool> free = observable(Eigen::Matrix2d::Zero(), Eigen::Vector2d(1.0, 1.0));
  EXPECT_FALSE(free[0] || free[1]);
}

TEST(ConstantsFit, GoesToTheMinimumWithThePinnedOnesInTheirPlace) {
  Eigen::Matrix2d S;
  S << 4.0, 1.0, 1.0, 2.0;
  const auto e = evidence(S, Eigen::Vector2d(0.3, -0.2));
  EXPECT_NEAR((best_change(e, {true, true}, Eigen::Vector2d::Zero()) - Eigen::Vector2d(0.3, -0.2)).norm(), 0.0, 1e-12);
  const Eigen::VectorXd pinned = best_change(e, {true, false}, Eigen::Vector2d(9.0, 0.0));
  EXPECT_NEAR(pinned[1], 0.0, 1e-12);
  EXPECT_NEAR(pinned[0], 0.3 + 1.0 / 4.0 * (-0.2 - 0.0), 1e-12);
  EXPECT_NEAR(chi2_change(e, Eigen::Vector2d(0.3, -0.2)), -0.3 * (1.2 - 0.2) + 0.2 * (0.3 - 0.4), 1e-12);
}

TEST(ConstantsFit, KeepsWhatTheHeldOutPartsConfirm) {
  const Eigen::Matrix2d S = Eigen::Vector2d(100.0, 100.0).asDiagonal();
  // The first constant is the same in both parts; the second contradicts itself.
  const std::vector<Fold> folds{{evidence(S, Eigen::Vector2d(1.0, 0.5)), evidence(S, Eigen::Vector2d(1.1, -0.5))},
                                {evidence(S, Eigen::Vector2d(1.1, -0.5)), evidence(S, Eigen::Vector2d(1.0, 0.5))}};
  const std::vector<bool> kept = confirmed(folds, {true, true}, Eigen::Vector2d::Zero());
  EXPECT_TRUE(kept[0]);
  EXPECT_FALSE(kept[1]);
  EXPECT_LT(held_out_chi2(folds, kept, Eigen::Vector2d::Zero()), 0.0);
}

}  // namespace
}  // namespace helixnav::apps
