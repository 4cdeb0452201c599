// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/acfr_recording.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/odometry.hpp"

namespace helixnav::logs {
namespace {

/// Two held samples; scans before the first, between the two, at the second and after the last.
AcfrLog small_log() {
  AcfrLog log;
  log.name = "small";
  log.dead_reckoning = {{100, 0.0, 0.0}, {200, 0.0, 0.0}};
  log.dead_reckoning[0] = {100'000'000, 2.0, 0.2};
  log.dead_reckoning[1] = {200'000'000, 3.0, -0.1};
  for (const core::Nanoseconds t_ns : {50'000'000, 130'000'000, 200'000'000, 250'000'000}) {
    SickScan& scan = log.scans.emplace_back();
    scan.t_ns = t_ns;
    scan.range_cm.fill(8191);
    scan.range_cm[270] = 1000;
    scan.reflectivity[270] = 2;
  }
  log.gps = {{120'000'000, {7.0, 8.0}}};
  using Sensor = AcfrLog::Sensor;
  log.order = {{Sensor::laser, 0}, {Sensor::dead_reckoning, 0}, {Sensor::gps, 0},  {Sensor::laser, 1},
               {Sensor::laser, 2}, {Sensor::dead_reckoning, 1}, {Sensor::laser, 3}};
  return log;
}

/// No calibration at all.
AcfrSettings as_recorded() {
  AcfrSettings settings;
  settings.speed_scale = 1.0;
  settings.steering_scale = 1.0;
  settings.steering_offset_rad = 0.0;
  settings.laser_delay_s = 0.0;
  settings.T_robot_laser = {3.78, 0.5, 0.0};
  settings.sigma_sideways_m_per_sqrt_m = 0.0;
  return settings;
}

std::vector<core::Odometry> increments(const core::Recording& recording) {
  std::vector<core::Odometry> all;
  for (const core::Event& event : recording.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      all.push_back(*odometry);
    }
  }
  return all;
}

TEST(MakeRecording, SplitsIncrementsExactlyAtTheScans) {
  const core::Recording recording = make_recording(small_log(), as_recorded());
  const auto parts = increments(recording);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].t_ns, 130'000'000);
  EXPECT_EQ(parts[1].t_ns, 200'000'000);
  EXPECT_EQ(parts[2].t_ns, 250'000'000);
  ASSERT_EQ(recording.events.size(), 7u);
  EXPECT_TRUE(std::holds_alternative<core::Scan>(recording.events[0]));
  EXPECT_EQ(recording.start.mean.vector(), Eigen::Vector3d::Zero());
  EXPECT_EQ(recording.start.covariance, Eigen::Matrix3d::Zero());
}

TEST(MakeRecording, MovesAndDoubtsAsMuchInPartsAsInTheWhole) {
  AcfrSettings settings = as_recorded();
  settings.steering_scale = 1.05;
  settings.steering_offset_rad = 0.01;
  const auto parts = increments(make_recording(small_log(), settings));
  const core::Odometry both = core::chain(parts[0], parts[1]);
  const core::Odometry whole = core::ackermann_increment(settings.geometry, settings.noise, {2.0, 0.22, 0.1});
  EXPECT_LT((both.T_before_after.vector() - whole.T_before_after.vector()).norm(), 1e-12);
  // Speed moves along x and both variances scale with the parts, so the largest terms agree to first order.
  EXPECT_NEAR(both.covariance(0, 0), whole.covariance(0, 0), 1e-3 * whole.covariance(0, 0));
  EXPECT_NEAR(both.covariance(2, 2), whole.covariance(2, 2), 1e-9 * whole.covariance(2, 2));
}

TEST(MakeRecording, SlipsSidewaysByTheWayHoweverItIsSplit) {
  AcfrSettings settings = as_recorded();
  const auto rolling = increments(make_recording(small_log(), settings));
  settings.sigma_sideways_m_per_sqrt_m = 0.3;
  const auto slipping = increments(make_recording(small_log(), settings));
  ASSERT_EQ(slipping.size(), rolling.size());
  for (std::size_t k = 0; k < slipping.size(); ++k) {
    const core::Pose2& moved = slipping[k].T_before_after;
    EXPECT_EQ(moved.vector(), rolling[k].T_before_after.vector()) << "slip has no mean";
    const Eigen::Matrix3d more = slipping[k].covariance - rolling[k].covariance;
    EXPECT_NEAR(more.trace(), 0.09 * moved.position_m().norm(), 1e-15) << "a part has its part of the way's variance";
    const Eigen::Vector3d chord(moved.x_m, moved.y_m, 0.0);
    EXPECT_LT((more * chord).norm(), 1e-15) << "across the chord only";
    EXPECT_EQ(more(2, 2), 0.0);
  }
}

TEST(MakeRecording, StampsAScanByWhenItWasTaken) {
  AcfrSettings settings = as_recorded();
  settings.laser_delay_s = 0.06;
  const auto parts = increments(make_recording(small_log(), settings));
  ASSERT_EQ(parts.size(), 3u) << "the scan that came in at 130 ms was taken before the first sample, at 70 ms";
  EXPECT_EQ(parts[0].t_ns, 140'000'000);
  EXPECT_EQ(parts[1].t_ns, 190'000'000);
  EXPECT_EQ(parts[2].t_ns, 200'000'000);
  EXPECT_DOUBLE_EQ(parts[1].T_before_after.heading_rad / parts[0].T_before_after.heading_rad, 50.0 / 40.0);
}

TEST(MakeRecording, SeesFromTheLaserWithBearingsCounterClockwiseFromAhead) {
  const core::Recording recording = make_recording(small_log(), as_recorded());
  const auto& scan = std::get<core::Scan>(recording.events[0]);
  EXPECT_EQ(scan.T_robot_sensor.vector(), Eigen::Vector3d(3.78, 0.5, 0.0));
  ASSERT_EQ(scan.observations.size(), 1u);
  EXPECT_NEAR(scan.observations[0].z[1], core::pi / 4.0, 1e-12);
  EXPECT_LT(scan.field_of_view.max_bearing_rad, core::pi / 2.0 + 1e-12);
}

TEST(MakeRecording, KeepsGpsAndBeaconsForEvaluationAndOutOfTheEvents) {
  AcfrLog log = small_log();
  log.beacons = {{3, {1.0, 2.0}}};
  const core::Recording recording = make_recording(log, car_park_settings());
  ASSERT_EQ(recording.true_positions.size(), 1u);
  EXPECT_EQ(recording.true_positions[0].position_m, Eigen::Vector2d(7.0, 8.0));
  EXPECT_EQ(recording.antenna_robot_m, Eigen::Vector2d(3.78, 0.5));
  EXPECT_EQ(recording.true_landmarks.at(0).label, 3);
  for (const core::Event& event : recording.events) {
    EXPECT_FALSE(std::holds_alternative<core::AbsoluteFix>(event));
  }
}

}  // namespace
}  // namespace helixnav::logs
