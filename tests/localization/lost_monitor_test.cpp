// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/localization/lost_monitor.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::localization {
namespace {

constexpr double reach_m = 30.0;

/// A row of landmarks every five metres on both sides of the x axis, 200 m of it.
std::vector<core::MapLandmark> avenue() {
  std::vector<core::MapLandmark> map;
  for (int k = 0; k < 40; ++k) {
    for (const double y_m : {-6.0, 6.0}) {
      core::MapLandmark landmark;
      landmark.id = static_cast<core::LandmarkId>(map.size());
      landmark.point.mean_m = {5.0 * k, y_m};
      map.push_back(landmark);
    }
  }
  return map;
}

struct Drive {
  LostMonitor monitor{avenue(), reach_m};
  double x_m = 0.0;

  /// One metre ahead; `seen` observations, the first `matched` of them matched.
  void step(int seen, int matched) {
    core::Scan scan;
    scan.field_of_view.max_range_m = reach_m;
    scan.field_of_view.min_bearing_rad = -0.5 * core::pi;
    scan.field_of_view.max_bearing_rad = 0.5 * core::pi;
    core::StepReport report;
    report.pose.mean = core::Pose2(x_m, 0.0, 0.0);
    for (int i = 0; i < seen; ++i) {
      core::AssociationReport& a = report.associations.emplace_back();
      a.observation = i;
      a.outcome = i < matched ? core::Outcome::matched : core::Outcome::rejected;
    }
    monitor.observe(scan, report, 1.0);
    x_m += 1.0;
  }
};

TEST(LostMonitor, TrustsAPoseFromWhichHalfTheMapIsSeen) {
  Drive drive;
  for (int k = 0; k < 150; ++k) {
    drive.step(10, 5);
    EXPECT_FALSE(drive.monitor.is_lost());
  }
}

TEST(LostMonitor, IsLostWhereEverythingExpectedIsMissingForAThirdOfTheReach) {
  Drive drive;
  for (int k = 0; k < 50; ++k) drive.step(8, 8);
  int lost_after = 0;
  EXPECT_TRUE(drive.monitor.is_confirmed());
  while (!drive.monitor.is_lost() && lost_after < 100) {
    drive.step(3, 0);
    ++lost_after;
  }
  EXPECT_GE(lost_after, 10);
  EXPECT_LE(lost_after, 12);
  drive.monitor.reset();
  EXPECT_FALSE(drive.monitor.is_lost());
  EXPECT_FALSE(drive.monitor.is_confirmed());
}

TEST(LostMonitor, OneScanWithoutASightIsNoLoss) {
  Drive drive;
  for (int k = 0; k < 100; ++k) {
    drive.step(8, k % 5 == 0 ? 0 : 8);
    EXPECT_FALSE(drive.monitor.is_lost());
  }
}

TEST(LostMonitor, BareGroundIsNoLossButUnknownThingsAllAroundAre) {
  Drive bare;
  bare.x_m = 1000.0;
  for (int k = 0; k < 200; ++k) bare.step(0, 0);
  EXPECT_FALSE(bare.monitor.is_lost());
  Drive elsewhere;
  elsewhere.x_m = 1000.0;
  for (int k = 0; k < 59; ++k) elsewhere.step(4, 0);
  EXPECT_FALSE(elsewhere.monitor.is_lost());
  elsewhere.step(4, 0);
  EXPECT_TRUE(elsewhere.monitor.is_lost());
}

TEST(LostMonitor, AnUnknownReachIsRefused) { EXPECT_THROW(LostMonitor({}, 0.0), core::PreconditionError); }

}  // namespace
}  // namespace helixnav::localization
