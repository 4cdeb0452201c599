// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/swings.hpp"

#include <gtest/gtest.h>

namespace helixnav::apps {
namespace {

Eigen::VectorXd both(double first, double second) { return Eigen::Vector2d(first, second); }

TEST(Swings, AreThoseOfTheLastThreeRoundsInStandardDeviations) {
  const Eigen::VectorXd swing =
      swings({both(9.0, 9.0), both(1.0, 2.0), both(3.0, 2.0), both(2.0, 2.0)}, both(0.5, 0.0));
  EXPECT_DOUBLE_EQ(swing[0], 4.0);
  EXPECT_DOUBLE_EQ(swing[1], 0.0);
}

TEST(Swings, AreARepetitionWhereAnEarlierRoundComesBack) {
  const Eigen::VectorXd sigmas = both(1.0, 1.0);
  EXPECT_TRUE(repeats({both(0.0, 0.0), both(1.0, 0.0), both(0.5, 0.0), both(0.01, 0.0)}, sigmas));
  EXPECT_FALSE(repeats({both(0.0, 0.0), both(1.0, 0.0), both(2.0, 0.0)}, sigmas));
  EXPECT_FALSE(repeats({both(1.0, 0.0), both(1.0, 0.0), both(1.0, 0.0)}, sigmas)) << "settled";
}

}  // namespace
}  // namespace helixnav::apps
