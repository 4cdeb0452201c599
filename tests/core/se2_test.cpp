// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/se2.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "central_differences.hpp"
#include "random_states.hpp"

namespace helixnav::core {
namespace {

using testing::pose_difference;
using testing::pose_distance;
using testing::random_pose;
using testing::states;

constexpr double law_tolerance = 1e-12 * 200.0;  // coordinates reach 200 m

TEST(Se2, ComposeIsAssociative) {
  RandomStream random(1, "se2");
  for (int i = 0; i < states; ++i) {
    const Pose2 a = random_pose(random), b = random_pose(random), c = random_pose(random);
    EXPECT_LT(pose_distance(compose(compose(a, b), c), compose(a, compose(b, c))), law_tolerance);
  }
}

TEST(Se2, IdentityIsNeutral) {
  RandomStream random(2, "se2");
  for (int i = 0; i < states; ++i) {
    const Pose2 a = random_pose(random);
    EXPECT_EQ(compose(a, {}).vector(), a.vector());
    EXPECT_EQ(compose({}, a).vector(), a.vector());
  }
}

TEST(Se2, InverseUndoesOnBothSides) {
  RandomStream random(3, "se2");
  for (int i = 0; i < states; ++i) {
    const Pose2 a = random_pose(random);
    EXPECT_LT(pose_distance(compose(a, inverse(a)), {}), law_tolerance);
    EXPECT_LT(pose_distance(compose(inverse(a), a), {}), law_tolerance);
    EXPECT_LT(pose_distance(inverse(inverse(a)), a), law_tolerance);
  }
}

TEST(Se2, BetweenIsWhatComposeNeedsToGetFromOneToTheOther) {
  RandomStream random(4, "se2");
  for (int i = 0; i < states; ++i) {
    const Pose2 a = random_pose(random), b = random_pose(random);
    EXPECT_LT(pose_distance(compose(a, between(a, b)), b), law_tolerance);
  }
}

TEST(Se2, TransformIsTheActionOfTheGroup) {
  RandomStream random(5, "se2");
  for (int i = 0; i < states; ++i) {
    const Pose2 a = random_pose(random), b = random_pose(random);
    const Eigen::Vector2d p = random_pose(random).position_m();
    EXPECT_LT((transform(compose(a, b), p) - transform(a, transform(b, p))).norm(), law_tolerance);
    EXPECT_LT((transform(inverse(a), transform(a, p)) - p).norm(), law_tolerance);
    EXPECT_LT((compose(a, b).position_m() - transform(a, b.position_m())).norm(), law_tolerance);
  }
}

TEST(Se2, HeadingsOfResultsLieInTheHalfOpenInterval) {
  RandomStream random(6, "se2");
  for (int i = 0; i < states; ++i) {
    const Pose2 a = random_pose(random), b = random_pose(random);
    for (const Pose2& T : {compose(a, b), inverse(a), between(a, b)}) {
      EXPECT_GT(T.heading_rad, -pi);
      EXPECT_LE(T.heading_rad, pi);
    }
  }
  EXPECT_EQ(inverse(Pose2(0.0, 0.0, pi)).heading_rad, pi);
}

TEST(Se2, RotationIsCounterClockwise) {
  EXPECT_LT((rotation(pi / 2.0) * Eigen::Vector2d::UnitX() - Eigen::Vector2d::UnitY()).norm(), 1e-15);
}

TEST(Se2, ComposeJacobiansEqualCentralDifferences) {
  RandomStream random(7, "se2");
  for (int i = 0; i < states; ++i) {
    const Pose2 a = random_pose(random), b = random_pose(random);
    const ComposeJacobians J = compose_jacobians(a, b);
    const auto by_first = [&](const Eigen::VectorXd& v) { return compose(Pose2(Eigen::Vector3d(v)), b).vector(); };
    const auto by_second = [&](const Eigen::VectorXd& v) { return compose(a, Pose2(Eigen::Vector3d(v))).vector(); };
    EXPECT_LT((helixnav::testing::central_differences(by_first, a.vector(), pose_difference) - J.J_first).norm(), 1e-7);
    EXPECT_LT((helixnav::testing::central_differences(by_second, b.vector(), pose_difference) - J.J_second).norm(),
              1e-7);
  }
}

}  // namespace
}  // namespace helixnav::core
