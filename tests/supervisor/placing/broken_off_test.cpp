// SPDX-License-Identifier: BSD-3-Clause
// A part of the drive that cannot be computed any further ends; the drive goes on beside its map until it finds its place there.
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/odometry.hpp"

namespace helixnav::supervisor {
namespace {

/// Positive semidefinite only to the rounding of its largest element: what is left of the heading variance is negative.
core::Odometry rounded_away(core::Nanoseconds t_ns) {
  core::Odometry odometry = core::no_motion(t_ns);
  odometry.covariance = Eigen::Vector3d(1e6, 1e6, -9e-4).asDiagonal();
  return odometry;
}

/// As if speeds were held through a gap.
core::Odometry through_gap(core::Nanoseconds t_ns) {
  core::Odometry odometry = core::no_motion(t_ns);
  odometry.T_before_after = {0.0, 0.0, 0.4};
  odometry.covariance = Eigen::Vector3d(30.0, 30.0, 4.0).asDiagonal();
  return odometry;
}

struct Parted {
  std::vector<core::CarriedDecision> parts;
  int placed = 0;
  double error_at_end_m = 0.0;
};

/// Round the circuit, with a motion that never took place inserted before some of its scans.
Parted drive_parted(core::Odometry (*motion)(core::Nanoseconds),
                    const std::function<bool(std::size_t scan)>& is_before) {
  const core::Recording run = sim::simulate(wide_circuit(), 1);
  Navigator navigator(run.start);
  Parted result;
  std::size_t scans = 0;
  for (const core::Event& event : run.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan != nullptr && is_before(scans++)) navigator.move(motion(scan->t_ns));
    const auto report = navigator.take(event);
    if (!report) continue;
    for (const core::Decision& decision : report->decisions) {
      if (const auto* part = std::get_if<core::CarriedDecision>(&decision)) result.parts.push_back(*part);
      const auto* place = std::get_if<core::PlacedDecision>(&decision);
      result.placed += place != nullptr && place->verdict == core::PlacedDecision::Verdict::accepted;
    }
  }
  const core::Pose2& truth = run.true_poses.back().T_world_robot;
  result.error_at_end_m = (navigator.pose().mean.position_m() - truth.position_m()).norm();
  return result;
}

bool is_scan_220(std::size_t scan) { return scan == 220; }

TEST(BrokenOff, IsAPartAndNotTheDrive) {
  const Parted drive = drive_parted(rounded_away, is_scan_220);
  ASSERT_EQ(drive.parts.size(), 1U);
  EXPECT_EQ(drive.parts[0].cause, core::CarriedDecision::Cause::broken_off);
  EXPECT_GE(drive.parts[0].landmarks, 15);
  EXPECT_EQ(drive.placed, 1);
  EXPECT_LT(drive.error_at_end_m, 0.8);
}

// Matched to first order, a heading known to ±115° becomes wrong by tens of degrees and is taken for certain.
TEST(NoOdometry, BeginsAPartThatFindsItsPlace) {
  const Parted drive = drive_parted(through_gap, is_scan_220);
  ASSERT_EQ(drive.parts.size(), 1U);
  EXPECT_EQ(drive.parts[0].cause, core::CarriedDecision::Cause::no_odometry);
  EXPECT_NEAR(drive.parts[0].heading_sigma_deg, 2.0 * 180.0 / core::pi, 1.0);
  EXPECT_NEAR(drive.parts[0].pose_sigma_m, std::sqrt(60.0), 0.2);
  EXPECT_EQ(drive.placed, 1);
  EXPECT_LT(drive.error_at_end_m, 0.8);
}

// A single gap does not define what is usual: the next one is found as well.
TEST(NoOdometry, BeginsAPartAtEachGap) {
  const Parted drive = drive_parted(through_gap, [](std::size_t scan) { return scan == 200 || scan == 300; });
  ASSERT_EQ(drive.parts.size(), 2U);
  EXPECT_EQ(drive.parts[1].cause, core::CarriedDecision::Cause::no_odometry);
  EXPECT_EQ(drive.placed, 2);
  EXPECT_LT(drive.error_at_end_m, 0.8);
}

// Odometry that is always like this is normal for this drive: a gap is judged against what is usual.
TEST(NoOdometry, IsNoneThatIsUsual) {
  EXPECT_TRUE(drive_parted(through_gap, [](std::size_t) { return true; }).parts.empty());
}

}  // namespace
}  // namespace helixnav::supervisor
