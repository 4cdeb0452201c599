// SPDX-License-Identifier: BSD-3-Clause
// What an update reports on its own arithmetic, for covariances with known pivots.
#include "helixnav/core/numerical_health.hpp"

#include <gtest/gtest.h>

#include "helixnav/cekf/compressed_ekf.hpp"

namespace helixnav::cekf {
namespace {

core::Observation point(double variance_m2) {
  return core::make_cartesian({5.0, 1.0}, variance_m2 * Eigen::Matrix2d::Identity());
}

/// A vehicle that knows its pose, and a landmark known with a variance of 1 m².
class NumericalHealth : public ::testing::Test {
 protected:
  CompressedEkf filter_{core::PoseGaussian{}};
  core::LandmarkId id_ = filter_.augment(point(1.0), {});
};

TEST_F(NumericalHealth, OfAFilterThatDidNothingIsWhole) {
  const core::NumericalHealth health = filter_.take_health();
  EXPECT_EQ(health.least_pivot, 1.0);
  EXPECT_EQ(health.asymmetry, 0.0);
  EXPECT_EQ(health.repaired, 0);
  EXPECT_EQ(health.refused, 0);
}

TEST_F(NumericalHealth, IsThatOfRowsThatTellNothingOfEachOther) {
  filter_.update({{id_, point(1.0), {}}});  // S is 2·I
  const core::NumericalHealth health = filter_.take_health();
  EXPECT_NEAR(health.least_pivot, 1.0, 1e-15);
  EXPECT_LT(health.asymmetry, 1e-15);
  EXPECT_FALSE(core::is_near_limit(health));
}

/// For the second sighting the first leaves 1 − 1/(1 + r)² of the variance.
TEST_F(NumericalHealth, FindsTheLeastPivotOfAnUpdateThatSaysAlmostTheSameTwice) {
  constexpr double r = 1e-9;
  filter_.update({{id_, point(r), {}}, {id_, point(r), {}}});
  const core::NumericalHealth health = filter_.take_health();
  EXPECT_NEAR(health.least_pivot / (2.0 * r), 1.0, 1e-6);
  EXPECT_FALSE(core::is_near_limit(health));
}

TEST_F(NumericalHealth, SaysThatTheLimitIsNear) {
  constexpr double r = 1e-13;
  filter_.update({{id_, point(r), {}}, {id_, point(r), {}}});
  const core::NumericalHealth health = filter_.take_health();
  EXPECT_LT(health.least_pivot, 1e-12);
  EXPECT_TRUE(core::is_near_limit(health));
}

TEST_F(NumericalHealth, IsForgottenOnceTaken) {
  filter_.update({{id_, point(1e-9), {}}, {id_, point(1e-9), {}}});
  filter_.take_health();
  EXPECT_EQ(filter_.take_health().least_pivot, 1.0);
}

TEST_F(NumericalHealth, GathersTheWorstOfSeveralUpdates) {
  filter_.update({{id_, point(1e-3), {}}, {id_, point(1e-3), {}}});
  filter_.update({{id_, point(1.0), {}}});
  EXPECT_NEAR(filter_.take_health().least_pivot, 2e-3, 1e-5);
}

TEST_F(NumericalHealth, IsNotThatOfQuestions) {
  const std::vector<Match> twice = {{id_, point(1e-9), {}}, {id_, point(1e-9), {}}};
  filter_.iterated_cost(twice);
  EXPECT_EQ(filter_.take_health().least_pivot, 1.0);
  filter_.update_iterated(twice);
  EXPECT_LT(filter_.take_health().least_pivot, 1e-8);
}

TEST(NumericalHealthOfSeveral, IsTheWorstOfEachAndTheSumOfWhatWasCounted) {
  core::NumericalHealth both{0.5, 1e-17, 1, 0};
  both.note({0.25, 1e-18, 2, 3});
  EXPECT_EQ(both.least_pivot, 0.25);
  EXPECT_EQ(both.asymmetry, 1e-17);
  EXPECT_EQ(both.repaired, 3);
  EXPECT_EQ(both.refused, 3);
}

}  // namespace
}  // namespace helixnav::cekf
