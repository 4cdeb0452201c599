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

}  // namespace
}  // namespace helixnav::supervisor
