// SPDX-License-Identifier: BSD-3-Clause
#include "split_motion.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/odometry.hpp"

namespace helixnav::team {
namespace {

TEST(SplitMotion, BothPartsChainedAreTheWhole) {
  for (const double turn_rad : {0.0, 0.4, -2.5}) {
    for (const double share : {0.1, 0.5, 0.93}) {
      core::Odometry whole;
      whole.t_ns = 10;
      whole.T_before_after = core::Pose2(1.2, 0.3, turn_rad);
      whole.covariance << 0.02, 0.003, 0.001, 0.003, 0.01, -0.002, 0.001, -0.002, 0.03;
      const auto [first, second] = split_motion(whole, share, 4);
      const core::Odometry both = core::chain(first, second);
      EXPECT_EQ(first.t_ns, 4);
      EXPECT_EQ(second.t_ns, 10);
      EXPECT_LT((both.T_before_after.vector() - whole.T_before_after.vector()).norm(), 1e-12);
      EXPECT_LT((both.covariance - whole.covariance).norm(), 1e-12);
    }
  }
}

TEST(SplitMotion, HalfOfAnArcIsOnTheArc) {
  core::Odometry circle;  // a quarter of a circle of radius 1
  circle.T_before_after = core::Pose2(1.0, 1.0, 0.5 * core::pi);
  const auto [first, second] = split_motion(circle, 0.5, 1);
  EXPECT_NEAR(first.T_before_after.x_m, std::sin(0.25 * core::pi), 1e-12);
  EXPECT_NEAR(first.T_before_after.y_m, 1.0 - std::cos(0.25 * core::pi), 1e-12);
}

}  // namespace
}  // namespace helixnav::team
