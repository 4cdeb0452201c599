// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/angle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "helixnav/core/random.hpp"

namespace helixnav::core {
namespace {

TEST(WrapToPi, KeepsPiAndTurnsMinusPiIntoIt) {
  EXPECT_EQ(wrap_to_pi(pi), pi);
  EXPECT_EQ(wrap_to_pi(-pi), pi);
  EXPECT_EQ(wrap_to_pi(3.0 * pi), pi);
  EXPECT_EQ(wrap_to_pi(-3.0 * pi), pi);
}

TEST(WrapToPi, LeavesTheNeighboursOfTheCutOnTheirSides) {
  const double below = std::nextafter(pi, 0.0);
  const double above = std::nextafter(pi, 4.0);
  EXPECT_EQ(wrap_to_pi(below), below);
  EXPECT_EQ(wrap_to_pi(-below), -below);
  EXPECT_LT(wrap_to_pi(above), -3.0);
  EXPECT_GT(wrap_to_pi(-above), 3.0);
}

TEST(WrapToPi, LeavesAnglesInsideUntouched) {
  for (const double angle : {0.0, 1e-300, -1e-300, 0.5, -3.1, 3.1}) EXPECT_EQ(wrap_to_pi(angle), angle);
}

TEST(WrapToPi, GivesAnEquivalentAngleInTheHalfOpenInterval) {
  RandomStream random(1, "angle");
  for (int i = 0; i < 10000; ++i) {
    const double angle = random.uniform(-1e4, 1e4);
    const double wrapped = wrap_to_pi(angle);
    EXPECT_GT(wrapped, -pi);
    EXPECT_LE(wrapped, pi);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-11);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-11);
  }
}

TEST(WrapToPi, HasNoAnswerForNanAndInfinity) {
  EXPECT_TRUE(std::isnan(wrap_to_pi(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(std::isnan(wrap_to_pi(std::numeric_limits<double>::infinity())));
  EXPECT_TRUE(std::isnan(wrap_to_pi(-std::numeric_limits<double>::infinity())));
}

}  // namespace
}  // namespace helixnav::core
