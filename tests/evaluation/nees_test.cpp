// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/evaluation/nees.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace helixnav::evaluation {
namespace {

core::PoseGaussian correlated(double correlation) {
  core::PoseGaussian pose;
  pose.covariance << 0.04, 0.0, 0.0, 0.0, 0.01, correlation * 0.1 * 0.02, 0.0, correlation * 0.1 * 0.02, 0.0004;
  return pose;
}

TEST(Nees, IsTheSquaredErrorInUnitsOfTheCovariance) {
  EXPECT_NEAR(nees(correlated(0.0), {0.2, 0.0, 0.0}), 1.0, 1e-12);
  EXPECT_NEAR(nees(correlated(0.0), {0.2, 0.1, 0.02}), 3.0, 1e-12);
  // (1, 1) of two errors correlated by ρ: 2 / (1 + ρ).
  EXPECT_NEAR(nees(correlated(0.99), {0.0, 0.1, 0.02}), 2.0 / 1.99, 1e-9);
}

// After motion given by speeds alone a vehicle cannot have moved sideways: its covariance has two dimensions, the rest is rounding,
// and one such instant would decide the mean of a whole drive.
TEST(Nees, IsNoneWhereTheCovarianceIsSingular) {
  EXPECT_TRUE(std::isnan(nees(correlated(1.0), {0.0, 1e-6, 0.0})));
  EXPECT_TRUE(std::isnan(nees(correlated(1.0 - 1e-12), {0.0, 1e-6, 0.0})));
  EXPECT_FALSE(std::isnan(nees(correlated(1.0 - 1e-6), {0.0, 1e-6, 0.0})));
  EXPECT_TRUE(std::isnan(nees(core::PoseGaussian(), {0.0, 0.0, 0.0})));
}

}  // namespace
}  // namespace helixnav::evaluation
