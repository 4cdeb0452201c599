// SPDX-License-Identifier: BSD-3-Clause
#include "own/rate_changes.hpp"

#include <gtest/gtest.h>

namespace helixnav::logs {
namespace {

core::Nanoseconds tenths(int count) { return count * core::Nanoseconds{100'000'000}; }

TEST(RateChanges, AreTheMeanSquareOfWhatTheRowsBeforeDid) {
  RateChanges changes;
  // Turn rates of 0 and 0.5 rad/s, five seconds each: one change of 0.25 (rad/s)² in five seconds.
  for (int i = 0; i <= 1000; ++i) changes.take(tenths(i), {1.0, 0.0, (i / 50) % 2 == 0 ? 0.0 : 0.5});
  EXPECT_NEAR(changes.variance_per_s().z(), 0.25 / 5.0, 0.005);
  EXPECT_NEAR(changes.variance_per_s().x(), 1.0 / 101.0, 1e-3) << "it began from rest";
  EXPECT_EQ(changes.variance_per_s().y(), 0.0);
}

TEST(RateChanges, HardlyTakeNoiseOfTheRowsForChanges) {
  RateChanges changes;
  for (int i = 0; i <= 1000; ++i) changes.take(tenths(i), {i % 2 == 0 ? 1.05 : 0.95, 0.0, 0.0});
  EXPECT_LT(changes.variance_per_s().x(), 0.02) << "row by row it would be 0.1";
}

TEST(RateChanges, MissRowsOnlyWhereTheLogHasThemElsewhere) {
  RateChanges often, when_it_changes;
  EXPECT_FALSE(often.is_gap(tenths(600)));
  for (int i = 0; i <= 20; ++i) often.take(tenths(i), Eigen::Vector3d::Ones());
  EXPECT_FALSE(often.is_gap(tenths(10)));
  EXPECT_TRUE(often.is_gap(tenths(11)));
  for (int i = 0; i <= 20; ++i) when_it_changes.take(tenths(30 * i), Eigen::Vector3d::Ones());
  EXPECT_FALSE(when_it_changes.is_gap(tenths(300)));
}

}  // namespace
}  // namespace helixnav::logs
