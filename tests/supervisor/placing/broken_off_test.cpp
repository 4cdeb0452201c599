// SPDX-License-Identifier: BSD-3-Clause
// A part of the drive that cannot be computed any further ends, and the drive goes on beside its map until it finds its place there.
#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/odometry.hpp"

namespace helixnav::supervisor {
namespace {

/// Positive semidefinite to the rounding of its largest element, and no further: what is left of the heading's variance is negative.
core::Odometry rounded_away(core::Nanoseconds t_ns) {
  core::Odometry odometry = core::no_motion(t_ns);
  odometry.covariance = Eigen::Vector3d(1e6, 1e6, -9e-4).asDiagonal();
  return odometry;
}

TEST(BrokenOff, IsAPartAndNotTheDrive) {
  const core::Recording run = sim::simulate(wide_circuit(), 1);
  constexpr std::size_t broken_at = 220;
  Navigator navigator(run.start);
  std::vector<core::CarriedDecision> parts;
  int placed = 0;
  std::size_t scans = 0;
  for (const core::Event& event : run.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan != nullptr && scans++ == broken_at) navigator.move(rounded_away(scan->t_ns));
    const auto report = navigator.take(event);
    if (!report) continue;
    for (const core::Decision& decision : report->decisions) {
      if (const auto* part = std::get_if<core::CarriedDecision>(&decision)) parts.push_back(*part);
      const auto* place = std::get_if<core::PlacedDecision>(&decision);
      placed += place != nullptr && place->verdict == core::PlacedDecision::Verdict::accepted;
    }
  }
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].cause, core::CarriedDecision::Cause::broken_off);
  EXPECT_GE(parts[0].landmarks, 15);
  EXPECT_EQ(placed, 1);
  const Eigen::Vector2d error_m = navigator.pose().mean.position_m() - run.true_poses.back().T_world_robot.position_m();
  EXPECT_LT(error_m.norm(), 0.8);
}

/// Before some scans, as from speeds held through a gap.
std::vector<core::CarriedDecision> parts_without_odometry(std::size_t from, std::size_t every, int& placed,
                                                          double& error_m) {
  const core::Recording run = sim::simulate(wide_circuit(), 1);
  Navigator navigator(run.start);
  std::vector<core::CarriedDecision> parts;
  std::size_t scans = 0;
  for (const core::Event& event : run.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan != nullptr && scans++ >= from && (scans - 1 - from) % every == 0) {
      core::Odometry gap = core::no_motion(scan->t_ns);
      gap.T_before_after = {0.0, 0.0, 0.4};
      gap.covariance = Eigen::Vector3d(30.0, 30.0, 4.0).asDiagonal();
      navigator.move(gap);
    }
    const auto report = navigator.take(event);
    if (!report) continue;
    for (const core::Decision& decision : report->decisions) {
      if (const auto* part = std::get_if<core::CarriedDecision>(&decision)) parts.push_back(*part);
      const auto* place = std::get_if<core::PlacedDecision>(&decision);
      placed += place != nullptr && place->verdict == core::PlacedDecision::Verdict::accepted;
    }
  }
  error_m = (navigator.pose().mean.position_m() - run.true_poses.back().T_world_robot.position_m()).norm();
  return parts;
}

// Matched to first order, a heading known to ±115° becomes wrong by tens of degrees and is taken for certain.
TEST(NoOdometry, BeginsAPartThatFindsItsPlace) {
  int placed = 0;
  double error_m = 0.0;
  const auto parts = parts_without_odometry(220, 100'000, placed, error_m);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].cause, core::CarriedDecision::Cause::no_odometry);
  EXPECT_NEAR(parts[0].heading_sigma_deg, 2.0 * 180.0 / core::pi, 1.0);
  EXPECT_NEAR(parts[0].pose_sigma_m, std::sqrt(60.0), 0.2);
  EXPECT_EQ(placed, 1);
  EXPECT_LT(error_m, 0.8);
}

// Odometry that is always so is what this drive has: it is told by what is usual.
TEST(NoOdometry, IsNoneThatIsUsual) {
  int placed = 0;
  double error_m = 0.0;
  EXPECT_TRUE(parts_without_odometry(0, 1, placed, error_m).empty());
}

}  // namespace
}  // namespace helixnav::supervisor
