// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/odometry.hpp"
#include "own_log_folder.hpp"

namespace helixnav::logs {
namespace {

/// Variance of the heading (rad²) after a drive whose heading is known to 4° after a full turn and no worse for any
/// other reason.
double heading_variance_after(const std::string& odometry) {
  const OwnLogFolder log;
  log.write(
      "vehicle.toml",
      "[odometry]\nsigma_heading_deg_per_sqrt_turn = 4\n[[sensor]]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
  log.write("odometry.csv", odometry);
  log.write("detections.csv", "t,range_m,bearing_deg\n0.25,10,1\n1,10,1\n2,10,1\n");
  core::Odometry way = core::no_motion(0);
  for (const core::Event& event : log.recording().events) {
    if (const auto* odometry_event = std::get_if<core::Odometry>(&event)) way = core::chain(way, *odometry_event);
  }
  return way.covariance(2, 2);
}

constexpr double after_a_turn_rad2 = (4.0 * core::pi / 180.0) * (4.0 * core::pi / 180.0);

TEST(TurningNoise, GrowsWithHowFarTheVehicleTurned) {
  EXPECT_NEAR(heading_variance_after("t,dx,dheading_deg\n0,0,0\n1,0,90\n2,0,90\n"), 0.5 * after_a_turn_rad2, 1e-12);
  EXPECT_NEAR(heading_variance_after("t,v,omega_degps\n0,0,180\n2,0,0\n"), after_a_turn_rad2, 1e-12);
}

TEST(TurningNoise, IsNotTakenBackByTurningBack) {
  EXPECT_NEAR(heading_variance_after("t,dx,dheading_deg\n0,0,0\n1,0,90\n2,0,-90\n"), 0.5 * after_a_turn_rad2, 1e-12);
}

TEST(TurningNoise, IsNoneStraightOnOrAtRest) {
  EXPECT_EQ(heading_variance_after("t,dx,dheading_deg\n0,0,0\n1,5,0\n2,0,0\n"), 0.0);
}

}  // namespace
}  // namespace helixnav::logs
