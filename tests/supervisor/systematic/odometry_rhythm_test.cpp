// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/odometry_rhythm.hpp"

#include <gtest/gtest.h>

#include "helixnav/supervisor/systematic_errors.hpp"

namespace helixnav::supervisor {
namespace {

constexpr core::Nanoseconds tenth_s = 100'000'000;

TEST(OdometryRhythm, IsSilentForMoreThanTenTimesTheUsualInterval) {
  OdometryRhythm rhythm;
  core::Nanoseconds t_ns = 5 * tenth_s;
  EXPECT_EQ(rhythm.until(t_ns).seconds, 0.0);
  EXPECT_EQ(rhythm.until(t_ns += 600 * tenth_s).silent_s, 0.0);  // nothing is usual yet
  rhythm.lose_last();
  EXPECT_EQ(rhythm.until(t_ns += 600 * tenth_s).seconds, 0.0);
  for (int k = 0; k < 580; ++k) EXPECT_EQ(rhythm.until(t_ns += tenth_s).silent_s, 0.0);
  const double usual_s = (60.0 + 58.0) / 581.0;
  EXPECT_EQ(rhythm.until(t_ns += 20 * tenth_s).silent_s, 0.0);
  for (int gap = 0; gap < 2; ++gap) {  // the first does not hide the second
    const TimeMoved time = rhythm.until(t_ns += 50 * tenth_s);
    EXPECT_NEAR(time.seconds, 5.0, 1e-12);
    EXPECT_NEAR(time.silent_s, 5.0 - usual_s, 0.01);
  }
}

/// One standard deviation off either way, whether the gyro ran on or not.
TEST(OdometryRhythm, LeavesOpenWhetherAGyroRanOn) {
  SystematicErrors errors;
  errors.turn_rad_per_s = 0.01;
  core::Odometry measured;
  const core::Odometry corrected = without(errors, measured, {31.0, 30.0});
  EXPECT_NEAR(corrected.T_before_after.heading_rad, -0.01 * (1.0 + 15.0), 1e-15);
  EXPECT_NEAR(corrected.covariance(2, 2), 0.15 * 0.15, 1e-15);
}

}  // namespace
}  // namespace helixnav::supervisor
