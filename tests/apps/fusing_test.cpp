// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "program.hpp"
#include "real_data.hpp"
#include "replay/fuse_gps.hpp"
#include "sanitized.hpp"

namespace helixnav::apps {
namespace {

using nlohmann::json;

class Fusing : public testing::RealDataTest {
 protected:
  json summary_of(std::vector<std::string> words) {
    const auto out = folder_.path() / "run";
    words.insert(words.end(), {"--out", out.string(), "--overwrite"});
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    said_ = outcome.out;
    return json::parse(text_of(out / "summary.json"));
  }

  testing::TemporaryFolder folder_;
  std::string said_;
};

TEST_F(Fusing, OfPlazaRangesEstimatesTheirScaleAndNavigatesWithinItsLimit) {
  find_real_data("plaza");
  if (IsSkipped()) return;
  const json error = summary_of({"replay", path_, "--association", "known"}).at("error");
  EXPECT_LE(error.at("rmse_m"), 0.5) << "promised: 1.5 m";
  EXPECT_EQ(error.at("fixes_left_out"), 0);
  EXPECT_GE(error.at("fixes_used"), 9600);
  const std::string words = "range scale estimated from the log: ";
  ASSERT_NE(said_.find(words), std::string::npos) << said_;
  // Compared with the true beacons and positions the ranges are too long by a factor of 1.070.
  EXPECT_NEAR(std::stod(said_.substr(said_.find(words) + words.size())), 1.070, 0.005);
}

TEST_F(Fusing, OfVictoriaParksGpsBringsTheDriveNearerToTheFixes) {
  find_real_data("victoria_park/raw/victoria_park_ascii.zip");
  if (IsSkipped()) return;
  const double fused_m = summary_of({"replay", path_, "--gps", "fuse"}).at("error").at("rmse_m");
  if (!support::sanitized) {
    EXPECT_LT(fused_m, 0.9 * summary_of({"replay", path_}).at("error").at("rmse_m").get<double>());
  }
  EXPECT_LT(fused_m, 1.3);
}

// Ten metres a second, a scan every half second, a fix 0.3 s after it: by then the vehicle was three metres further on.
TEST(FuseGps, UsesAFixWhereTheVehicleWasThen) {
  core::Recording recording;
  recording.events.emplace_back(core::Scan{});
  for (int k = 1; k <= 40; ++k) {
    core::Odometry moved = core::no_motion(core::nanoseconds_from_seconds(0.5 * k));
    moved.T_before_after.x_m = 5.0;
    moved.covariance = Eigen::Vector3d(0.01, 0.01, 1e-8).asDiagonal();
    recording.events.emplace_back(moved);
    recording.events.emplace_back(core::Scan{moved.t_ns, {}, {}, {}});
    const double t_s = 0.5 * k - 0.2;
    recording.true_positions.push_back({core::nanoseconds_from_seconds(t_s), {10.0 * t_s, 0.0}, 0.05});
  }
  fuse_gps(recording, {true, 0.05, 30.0});
  supervisor::Navigator navigator(recording.start);
  for (const core::Event& event : recording.events) {
    navigator.take(event);
    if (std::holds_alternative<core::Odometry>(event)) continue;  // used with the next event
    const double x_m = 10.0 * core::seconds(core::time_of(event));
    EXPECT_NEAR(navigator.pose().mean.x_m, x_m, 1e-6);
  }
}

// The way until the first fix says nothing of the start's heading, and does not count.
TEST(FuseGps, AlignsTheStartToTheFirstFixesHoweverLateTheyBegin) {
  core::Recording recording;
  recording.events.emplace_back(core::Scan{});
  for (int k = 1; k <= 60; ++k) {
    core::Odometry moved = core::no_motion(core::nanoseconds_from_seconds(0.5 * k));
    moved.T_before_after.x_m = 5.0;
    moved.covariance = Eigen::Vector3d(0.01, 0.01, 1e-8).asDiagonal();
    recording.events.emplace_back(moved);
    const double error_m = k % 2 == 0 ? 0.3 : -0.3;
    if (k > 24) recording.true_positions.push_back({moved.t_ns, {5.0 * k, error_m}, 0.3});
  }
  fuse_gps(recording, {true, 0.3, 30.0});
  EXPECT_LT(std::sqrt(recording.start.covariance(2, 2)), 2.5 * core::pi / 180.0);
  EXPECT_NEAR(recording.start.mean.heading_rad, 0.0, 0.05);
}

/// The same drive with true poses that begin at the origin of the map, as such a log gives them; fixes in a grid frame.
core::Recording drive_with_truth(const core::Pose2& T_grid_map, const core::Pose2& T_truth_map) {
  core::Recording recording;
  recording.antenna_robot_m = {1.0, 0.5};
  recording.truth_frame.T_truth_map = T_truth_map;
  recording.events.emplace_back(core::Scan{});
  for (int k = 0; k <= 40; ++k) {
    core::Odometry moved = core::no_motion(core::nanoseconds_from_seconds(0.5 * k));
    moved.T_before_after.x_m = 5.0;
    moved.covariance = Eigen::Vector3d(0.01, 0.01, 1e-8).asDiagonal();
    if (k > 0) recording.events.emplace_back(moved);
    const core::Pose2 T_map_robot(5.0 * k, 0.0, 0.0);
    recording.true_poses.push_back({moved.t_ns, T_map_robot});
    const Eigen::Vector2d antenna_m = core::transform(T_map_robot, recording.antenna_robot_m);
    recording.true_positions.push_back({moved.t_ns, core::transform(T_grid_map, antenna_m), 0.5});
  }
  recording.true_landmarks.push_back({0, {10.0, 5.0}});
  return recording;
}

TEST(FuseGps, IsJudgedByTheTruePosesInTheFrameOfTheFixes) {
  const core::Pose2 T_grid_map(3.0e5, 5.4e6, 0.7);
  core::Recording recording = drive_with_truth(T_grid_map, T_grid_map);
  fuse_gps(recording, {true, 0.5, 30.0});
  EXPECT_TRUE(recording.true_positions.empty());
  EXPECT_TRUE(recording.truth_frame.is_map);
  ASSERT_EQ(recording.true_poses.size(), 41U);
  EXPECT_NEAR(recording.true_poses[2].T_world_robot.x_m, 3.0e5 + 10.0 * std::cos(0.7), 1e-6);
  EXPECT_NEAR(recording.true_poses[2].T_world_robot.heading_rad, 0.7, 1e-9);
  EXPECT_NEAR(recording.true_poses[0].T_world_robot.y_m, recording.start.mean.y_m, 1e-3);
  const Eigen::Vector2d landmark_m = core::transform(T_grid_map, {10.0, 5.0});
  EXPECT_NEAR((recording.true_landmarks[0].point_m - landmark_m).norm(), 0.0, 1e-6);
}

// A circle; the antenna is two metres beside where it is stated. No motion of the truth explains that.
TEST(FuseGps, IsJudgedInTheFrameOfTheFixesAlsoIfTheseErr) {
  core::Recording recording;
  recording.truth_frame.T_truth_map = core::Pose2();
  recording.events.emplace_back(core::Scan{});
  core::Pose2 T_map_robot;
  for (int k = 0; k <= 60; ++k) {
    core::Odometry moved = core::no_motion(core::nanoseconds_from_seconds(0.5 * k));
    moved.T_before_after = {3.0, 0.0, 0.1};
    moved.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
    if (k > 0) {
      recording.events.emplace_back(moved);
      T_map_robot = core::compose(T_map_robot, moved.T_before_after);
    }
    recording.true_poses.push_back({moved.t_ns, T_map_robot});
    recording.true_positions.push_back({moved.t_ns, core::transform(T_map_robot, {0.0, 2.0}), 0.2});
  }
  fuse_gps(recording, {true, 0.2, 30.0});
  EXPECT_TRUE(recording.truth_frame.is_map);
}

TEST(FuseGps, AlignsTruePosesThatAreOfAnotherFrameThanTheFixes) {
  core::Recording recording = drive_with_truth({3.0e5, 5.4e6, 0.7}, {12.0, 3.0, 0.0});
  fuse_gps(recording, {true, 0.5, 30.0});
  EXPECT_TRUE(recording.true_positions.empty());
  EXPECT_FALSE(recording.truth_frame.is_map);
  EXPECT_EQ(recording.true_poses.size(), 41U);
}

}  // namespace
}  // namespace helixnav::apps
