// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/interpolate.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/odometry.hpp"

namespace helixnav::core {
namespace {

TEST(Interpolate, FollowsTheArcOfAQuarterCircle) {
  const Pose2 end(10.0, 10.0, pi / 2);
  const Pose2 middle = interpolate({}, end, 0.5);
  EXPECT_NEAR(middle.x_m, 10.0 * std::sin(pi / 4), 1e-12);
  EXPECT_NEAR(middle.y_m, 10.0 * (1.0 - std::cos(pi / 4)), 1e-12);
  EXPECT_NEAR(middle.heading_rad, pi / 4, 1e-12);
}

TEST(Interpolate, TakesTheShortWayRoundAtPi) {
  const Pose2 middle = interpolate({0.0, 0.0, 3.1}, {0.0, 0.0, -3.1}, 0.5);
  EXPECT_NEAR(std::abs(middle.heading_rad), pi, 1e-12);
}

TEST(Split, ChainsToTheWhole) {
  Odometry whole;
  whole.t_ns = 1'000'000'000;
  whole.T_before_after = {1.5, 0.4, 0.7};
  whole.covariance << 0.04, 0.005, 0.0, 0.005, 0.01, 0.0, 0.0, 0.0, 1e-4;
  for (const double fraction : {0.0, 0.2, 0.5, 1.0}) {
    const auto [first, second] = split(whole, fraction, 300'000'000);
    EXPECT_EQ(first.t_ns, 300'000'000);
    EXPECT_EQ(second.t_ns, whole.t_ns);
    const Odometry both = chain(first, second);
    EXPECT_TRUE(both.T_before_after.vector().isApprox(whole.T_before_after.vector(), 1e-12));
    EXPECT_NEAR((both.covariance - whole.covariance).cwiseAbs().maxCoeff(), 0.0, 1e-4)
        << "the lever of the first one's heading";
    EXPECT_NEAR(first.covariance.trace(), fraction * whole.covariance.trace(), 1e-15);
    EXPECT_TRUE(second.covariance.isApprox(second.covariance.transpose()));
  }
}

}  // namespace
}  // namespace helixnav::core
