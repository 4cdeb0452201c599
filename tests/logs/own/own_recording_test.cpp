// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "helixnav/core/odometry.hpp"
#include "own/motion.hpp"
#include "own_log_folder.hpp"

namespace helixnav::logs {
namespace {

/// The whole motion of a recording.
core::Odometry way_of(const core::Recording& recording) {
  core::Odometry way = core::no_motion(0);
  for (const core::Event& event : recording.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) way = core::chain(way, *odometry);
  }
  return way;
}

void expect_near(const core::Pose2& a, const core::Pose2& b, double tolerance) {
  EXPECT_NEAR(a.x_m, b.x_m, tolerance);
  EXPECT_NEAR(a.y_m, b.y_m, tolerance);
  EXPECT_NEAR(core::wrap_to_pi(a.heading_rad - b.heading_rad), 0.0, tolerance);
}

TEST(Motion, OfATwistIsTheArcOfFineIntegration) {
  const Eigen::Vector3d twist(2.0, 0.5, 1.5);
  core::Pose2 pose;
  constexpr int steps = 100'000;
  for (int i = 0; i < steps; ++i) pose = core::compose(pose, core::Pose2(Eigen::Vector3d(twist / steps)));
  expect_near(exponential(twist), pose, 1e-4);
  EXPECT_TRUE(logarithm(exponential(twist).vector()).isApprox(twist, 1e-12));
  const Eigen::Vector3d tiny(1.0, 0.1, 1e-6);
  EXPECT_TRUE(logarithm(exponential(tiny).vector()).isApprox(tiny, 1e-12));
}

/// Ten seconds at 2 m/s and 0.1 rad/s, given in each form.
TEST(OwnRecording, OfEveryKindOfOdometryIsTheSameWay) {
  constexpr double v_mps = 2.0, omega_radps = 0.1, wheelbase_m = 1.5, track_m = 0.8;
  const core::Pose2 whole = exponential({v_mps * 10.0, 0.0, omega_radps * 10.0});
  const OwnLogFolder log;
  log.write("vehicle.toml",
            "[odometry]\nwheelbase_m = 1.5\ntrack_m = 0.8\nsigma_along_m_per_sqrt_m = 0.02\n"
            "[[sensor]]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
  log.write("detections.csv", "t,range_m,bearing_deg\n0,10,1\n3.3,10,1\n10,10,1\n");
  std::string velocities = "t,v,omega\n", steering = "t,v,steering_rad\n", wheels = "t,v_left,v_right\n";
  std::string increments = "t,dx,dy,dheading\n0,0,0,0\n", poses = "t,x,y,heading\n";
  const core::Pose2 step = exponential({v_mps, 0.0, omega_radps});
  core::Pose2 pose(5.0, -3.0, 2.9);
  for (int t = 0; t <= 10; ++t) {
    const auto row = [&](std::initializer_list<double> values) {
      std::string text = std::to_string(t);
      for (const double value : values) text += "," + std::to_string(value * 1e6) + "e-6";
      return text + "\n";
    };
    velocities += row({v_mps, omega_radps});
    steering += row({v_mps, std::atan(omega_radps * wheelbase_m / v_mps)});
    wheels += row({v_mps - 0.5 * omega_radps * track_m, v_mps + 0.5 * omega_radps * track_m});
    if (t > 0) increments += row({step.x_m, step.y_m, step.heading_rad});
    poses += row({pose.x_m, pose.y_m, pose.heading_rad});
    pose = core::compose(pose, step);
  }
  for (const std::string& table : {velocities, steering, wheels, increments, poses}) {
    log.write("odometry.csv", table);
    const core::Recording recording = log.recording();
    SCOPED_TRACE(table.substr(0, table.find('\n')));
    expect_near(way_of(recording).T_before_after, whole, 1e-8);
    EXPECT_NEAR(way_of(recording).covariance(0, 0) + way_of(recording).covariance(1, 1), 20.0 * 0.02 * 0.02,
                0.1 * 20 * 0.0004);
    EXPECT_EQ(recording.events.size(), 5u);  // three scans, two increments between them
  }
}

/// Straight ahead for a second at 2 m/s, by two wheels.
core::Odometry way_by_wheels(const std::string& noise) {
  const OwnLogFolder log;
  log.write("vehicle.toml",
            "[odometry]\ntrack_m = 0.8\n" + noise + "[[sensor]]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
  log.write("detections.csv", "t,range_m,bearing_deg\n0,10,1\n1,10,1\n");
  log.write("odometry.csv", "t,v_left,v_right\n0,2,2\n1,2,2\n");
  return way_of(log.recording());
}

TEST(OwnRecording, TakesTheNoiseOfSpeedForThatOfEachWheelUnlessThatOfTheTurnRateIsTold) {
  const core::Odometry each = way_by_wheels("sigma_v_mps = 0.2\n");
  EXPECT_NEAR(each.covariance(0, 0), 0.5 * 0.2 * 0.2, 1e-12);
  EXPECT_NEAR(each.covariance(2, 2), 2.0 * 0.2 * 0.2 / (0.8 * 0.8), 1e-12);
  const core::Odometry both = way_by_wheels("sigma_v_mps = 0.2\nsigma_omega_rad_per_s = 0.03\n");
  EXPECT_NEAR(both.covariance(0, 0), 0.2 * 0.2, 1e-12);
  EXPECT_NEAR(both.covariance(2, 2), 0.03 * 0.03, 1e-12);
}

TEST(OwnRecording, SplitsMotionAtScansInProportionToTime) {
  const OwnLogFolder log;
  log.write("odometry.csv", "t,dx,dheading\n0,0,0\n1,1,0\n");
  log.write("detections.csv", "t,range_m,bearing_deg\n0.25,10,1\n1,10,1\n");
  const core::Recording recording = log.recording();
  ASSERT_EQ(recording.events.size(), 4u);
  EXPECT_NEAR(std::get<core::Odometry>(recording.events[0]).T_before_after.x_m, 0.25, 1e-12);
  EXPECT_NEAR(std::get<core::Odometry>(recording.events[2]).T_before_after.x_m, 0.75, 1e-12);
}

TEST(OwnRecording, CorrectsOdometryByScaleBiasAndPlace) {
  const OwnLogFolder log;
  log.write("odometry.csv", "t,v,omega\n0,1,0.5\n1,0,0\n");
  log.write("detections.csv", "t,range_m,bearing_deg\n0,10,1\n1,10,1\n");
  log.write("vehicle.toml",
            "[odometry]\nscale = 2\nturn_scale = 4\nturn_bias_rad_per_s = 0.5\nsigma_along_m_per_sqrt_m = 0.02\n"
            "[[sensor]]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
  expect_near(way_of(log.recording()).T_before_after, exponential({2.0, 0.0, 1.5}), 1e-12);
  // Odometry 1 m ahead of the vehicle's origin, turning on the spot: the origin moves sideways.
  log.write("odometry.csv", "t,v,omega\n0,0,0.5\n1,0,0\n");
  log.write("vehicle.toml",
            "[odometry]\nx_m = 1\nsigma_heading_deg_per_sqrt_s = 1\n"
            "[[sensor]]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
  const core::Odometry way = way_of(log.recording());
  expect_near(way.T_before_after, {1.0 - std::cos(0.5), -std::sin(0.5), 0.5}, 1e-12);
  EXPECT_GT(way.covariance(1, 1), 0.5 * way.covariance(2, 2));
}

/// Rows every 0.1 s until 1 s; then nothing until 121 s. The last row before the gap is `last`.
core::Odometry way_through_gap(const std::string& columns, const std::string& driving, const std::string& last) {
  const OwnLogFolder log;
  log.write("vehicle.toml",
            "[odometry]\nwheelbase_m = 1.5\ntrack_m = 0.8\nsigma_v_mps = 0.2\nsigma_omega_deg_per_s = 1.5\n"
            "sigma_steering_deg = 1\nturn_bias_deg_per_s = 0.5\n"
            "[[sensor]]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
  log.write("detections.csv", "t,range_m,bearing_deg\n1,10,1\n121,10,1\n");
  std::string rows = columns + "\n";
  for (const char* t : {"0.7", "0.8", "0.9"}) rows += t + std::string(",") + driving + "\n";
  rows += "1.0," + last + "\n121," + driving + "\n";
  log.write("odometry.csv", rows);
  const core::Recording recording = log.recording();
  const auto is_odometry = [](const core::Event& event) { return std::holds_alternative<core::Odometry>(event); };
  const auto at = std::find_if(recording.events.rbegin(), recording.events.rend(), is_odometry);
  return at == recording.events.rend() ? core::no_motion(0) : std::get<core::Odometry>(*at);
}

// Errors that occur at speed do not add up at rest: a vehicle parked for two minutes is not turned by ±180°.
TEST(OwnRecording, AVehicleThatStandsThroughAGapStaysWhereItIs) {
  for (const auto& [columns, driving, stands] : {std::array<std::string, 3>{"t,v,omega", "2,0.1", "0,0"},
                                                 {"t,v,steering_rad", "2,0.1", "0,0.1"},
                                                 {"t,v_left,v_right", "2,2", "0,0"}}) {
    SCOPED_TRACE(columns);
    const core::Odometry stood = way_through_gap(columns, driving, stands);
    EXPECT_EQ(stood.T_before_after.vector().norm(), 0.0);
    EXPECT_GT(stood.covariance(0, 0), 0.0);
    EXPECT_LT(std::sqrt(stood.covariance(0, 0)), 0.1 * 0.2 + 1e-9) << "that of the usual interval";
    EXPECT_LT(std::sqrt(stood.covariance(2, 2)), 0.1 * 0.4);
    const core::Odometry moved = way_through_gap(columns, driving, driving);
    EXPECT_GT(std::sqrt(moved.covariance(0, 0)), 10.0) << "where it went meanwhile nobody knows";
  }
}

TEST(OwnRecording, TakesNoiseFromTheLogBeforeTheVehicle) {
  const OwnLogFolder log;
  log.write("odometry.csv", "t,dx,dheading,sigma_x,sigma_y,sigma_heading\n0,0,0,0,0,0\n1,1,0,0.1,0.2,0.3\n");
  log.write("detections.csv", "t,range_m,bearing_deg,sigma_range_m,sigma_bearing_deg\n1,10,1,,\n1,10,5,0.5,2\n");
  const core::Recording recording = log.recording();
  const Eigen::Matrix3d Q = std::get<core::Odometry>(recording.events[0]).covariance;
  EXPECT_NEAR(Q(0, 0), 0.01, 1e-12);
  EXPECT_NEAR(Q(2, 2), 0.09, 1e-12);
  const auto& seen = std::get<core::Scan>(recording.events[1]).observations;
  EXPECT_NEAR(std::sqrt(seen[0].R(0, 0)), 0.05, 1e-12);
  EXPECT_NEAR(std::sqrt(seen[1].R(0, 0)), 0.5, 1e-12);
  EXPECT_NEAR(std::sqrt(seen[1].R(1, 1)) * 180.0 / core::pi, 2.0, 1e-12);
}

TEST(OwnRecording, TakesTheNoiseThatHasNoColumnFromTheSensor) {
  const OwnLogFolder log;
  log.write("odometry.csv", "t,dx,dheading,sigma_x,sigma_y,sigma_heading\n0,0,0,0,0,0\n1,1,0,0.1,0.2,0.3\n");
  log.write("detections.csv", "t,range_m,bearing_deg,sigma_range_m\n1,10,1,0.5\n1,10,5,\n");
  const core::Recording recording = log.recording();
  const auto& seen = std::get<core::Scan>(recording.events[1]).observations;
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_NEAR(std::sqrt(seen[0].R(0, 0)), 0.5, 1e-12);
  EXPECT_NEAR(std::sqrt(seen[0].R(1, 1)) * 180.0 / core::pi, 0.2, 1e-12);
  EXPECT_NEAR(std::sqrt(seen[1].R(0, 0)), 0.05, 1e-12);
}

TEST(OwnRecording, GivesEachSensorItsMountingViewAndDelay) {
  const OwnLogFolder log;
  log.write("vehicle.toml",
            "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\n"
            "[[sensor]]\nname = \"front\"\nx_m = 1\nreach_m = 40\nview_deg = [-90, 90]\nsigma_range_m = "
            "0.05\nsigma_bearing_deg = 1\n"
            "[[sensor]]\nname = \"rear\"\nx_m = -1\nheading_deg = 180\nreach_m = 10\nreliable_range_m = "
            "8\nsigma_range_m = 0.1\n"
            "sigma_bearing_deg = 1\ndelay_s = 0.5\n");
  log.write("detections.csv", "t,sensor,range_m,bearing_deg\n1,front,10,0\n1,rear,5,0\n");
  const core::Recording recording = log.recording();
  std::vector<core::Scan> scans;
  for (const core::Event& event : recording.events) {
    if (const auto* scan = std::get_if<core::Scan>(&event)) scans.push_back(*scan);
  }
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[0].t_ns, 500'000'000);
  EXPECT_DOUBLE_EQ(scans[0].T_robot_sensor.x_m, -1.0);
  EXPECT_DOUBLE_EQ(scans[0].field_of_view.max_range_m, 8.0);
  EXPECT_DOUBLE_EQ(*scans[0].field_of_view.reach(), 10.0);
  EXPECT_DOUBLE_EQ(scans[1].field_of_view.max_bearing_rad, core::pi / 2);
  EXPECT_DOUBLE_EQ(*scans[1].field_of_view.reach(), 40.0);
}

TEST(OwnRecording, HasNoLabelsIfOnlyTheTrueLandmarksHaveIdentities) {
  OwnLogFolder folder;
  folder.write("truth_landmarks.csv", "id,x_m,y_m\nT0,1,2\nT1,3,4\n");
  EXPECT_TRUE(folder.recording().labels.empty());
}

TEST(OwnRecording, PutsTruthIntoTheFrameOfTheStart) {
  const OwnLogFolder log;
  log.write("truth_poses.csv", "t,x,y,heading_deg\n0,100,50,90\n2,100,60,90\n");
  log.write("truth_landmarks.csv", "x,y\n100,70\n");
  const core::Recording recording = log.recording();
  ASSERT_EQ(recording.true_poses.size(), 2u);
  expect_near(recording.true_poses[1].T_world_robot, {10.0, 0.0, 0.0}, 1e-9);
  EXPECT_NEAR(recording.true_landmarks.at(0).point_m.x(), 20.0, 1e-9);
}

TEST(OwnRecording, BeginsTheTruthBeforeTheFirstIncrementWhoseTimeIsItsEnd) {
  const char* const known_before = "t,x,y,heading_deg\n0,100,50,90\n1,100,51,90\n2,100,52,90\n";
  const char* const not_known_before = "t,x,y,heading_deg\n1,100,51,90\n2,100,52,90\n";
  for (const char* truth : {known_before, not_known_before}) {
    const OwnLogFolder log;
    log.write("odometry.csv", "t,dx,dheading\n1,1,0\n2,1,0\n");
    log.write("detections.csv", "t,range_m,bearing_deg\n1,10,0\n2,9,0\n");
    log.write("truth_poses.csv", truth);
    const core::Recording recording = log.recording();
    SCOPED_TRACE(truth);
    expect_near(recording.true_poses.back().T_world_robot, {2.0, 0.0, 0.0}, 1e-9);
  }
}

/// The first increment is taken to have lasted as long as the second: the scan is in the middle of it.
TEST(OwnRecording, MovesBeforeAScanWithinTheFirstIncrement) {
  const OwnLogFolder log;
  log.write("odometry.csv", "t,dx,dheading\n1,1,0\n2,1,0\n");
  log.write("detections.csv", "t,range_m,bearing_deg\n0.5,10,0\n1.5,9,0\n");
  log.write("truth_poses.csv", "t,x,y,heading_deg\n0.5,100,50,90\n2,100,51.5,90\n");
  const core::Recording recording = log.recording();
  expect_near(std::get<core::Odometry>(recording.events.front()).T_before_after, {0.5, 0.0, 0.0}, 1e-9);
  expect_near(recording.true_poses.back().T_world_robot, {2.0, 0.0, 0.0}, 1e-9);
}

/// The vehicle does not stop with certainty where odometry ends.
TEST(OwnRecording, HoldsTheLastRatesOfIncrementsForAScanJustAfterThem) {
  for (const char* odometry : {"t,dx,dheading\n0,0,0\n1,8,0\n2,8,0\n", "t,x,y,heading\n0,0,0,0\n1,8,0,0\n2,16,0,0\n"}) {
    const OwnLogFolder log;
    log.write("odometry.csv", odometry);
    log.write("detections.csv", "t,range_m,bearing_deg\n0.5,10,0\n2,9,0\n2.5,5,0\n");
    const core::Recording recording = log.recording();
    const auto& beyond = std::get<core::Odometry>(recording.events.at(recording.events.size() - 2));
    expect_near(beyond.T_before_after, {4.0, 0.0, 0.0}, 1e-9);
    EXPECT_GT(std::sqrt(beyond.covariance(0, 0)), 0.3) << "it may brake meanwhile";
  }
}

TEST(OwnRecording, DrivesByOdometryFromTheStartToATruthThatBeginsLater) {
  const OwnLogFolder log;
  log.write("odometry.csv", "t,v,omega\n0,4,0\n0.2,4,0\n0.4,4,0\n2,4,0\n");
  log.write("detections.csv", "t,range_m,bearing_deg\n0.5,10,0\n1.5,9,0\n");
  log.write("truth_poses.csv", "t,x,y,heading_deg\n0.25,100,51,90\n2,100,58,90\n");
  expect_near(log.recording().true_poses.front().T_world_robot, {1.0, 0.0, 0.0}, 1e-9);
}

TEST(OwnRecording, HandsOutFixesForComparison) {
  const OwnLogFolder log;
  log.write("fixes.csv", "t,x,y,sigma\n0,100,50,0.5\n2,100,60,\n");
  const core::Recording recording = log.recording();
  ASSERT_EQ(recording.true_positions.size(), 2u);
  EXPECT_DOUBLE_EQ(recording.true_positions[0].sigma_m, 0.5);
  EXPECT_DOUBLE_EQ(recording.true_positions[1].sigma_m, 0.0);
}

}  // namespace
}  // namespace helixnav::logs
