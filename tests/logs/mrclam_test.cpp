// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/mrclam.hpp"

#include <cmath>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "helixnav/core/odometry.hpp"
#include "input_error.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

using testing::input_error_of;
using testing::TemporaryFolder;

const char* const commands =
    "# robot,t,v,w\n1,0.0,1.0,0.0\n1,1.0,0.0,0.5\n1,2.0,0.0,0.0\n1,4.0,0.0,0.0\n"
    "2,0.0,0.5,0.0\n2,4.0,0.0,0.0\n";
const char* const sightings =
    "1,0.5,63,6,2.0,0.1\n1,0.5,14,2,3.0,-0.2\n1,1.5,99,0,1.0,0.0\n2,2.0,63,6,1.5,0.3\n2,3.0,5,1,2.0,0.0\n";
const char* const true_landmarks = "# s,x,y,sx,sy\n6,1.0,2.0,1e-4,1e-4\n";

class MrclamFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("odometry.csv", commands);
    folder_.write("measurements.csv", sightings);
    folder_.write("landmarks_true.csv", true_landmarks);
  }
  std::string error() const {
    return input_error_of([&] { read_mrclam(folder_.path()); });
  }
  TemporaryFolder folder_;
};

core::Odometry all_motion(const core::Recording& recording, core::Nanoseconds until_ns) {
  core::Odometry all = core::no_motion(0);
  for (const core::Event& event : recording.events) {
    const auto* motion = std::get_if<core::Odometry>(&event);
    if (motion != nullptr && motion->t_ns <= until_ns) all = core::chain(all, *motion);
  }
  return all;
}

TEST_F(MrclamFolder, HoldsACommandUntilTheNext) {
  const core::TeamRecording team = read_mrclam(folder_.path());
  ASSERT_EQ(team.robots.size(), 2u);
  const core::Pose2 at_one = all_motion(team.robots[0].recording, 1'000'000'000).T_before_after;
  const core::Pose2 at_end = all_motion(team.robots[0].recording, 4'000'000'000).T_before_after;
  EXPECT_NEAR(at_one.x_m, 1.0, 1e-12);
  EXPECT_NEAR(at_end.heading_rad, 0.5, 1e-12);
}

TEST_F(MrclamFolder, EndsIncrementsWhereTheRobotWasSeen) {
  folder_.write("measurements.csv", "1,0.53,63,6,2.0,0.1\n1,1.27,14,2,3.0,-0.2\n2,3.0,63,6,2.0,0.0\n");
  const core::TeamRecording team = read_mrclam(folder_.path());
  bool ends_there = false;
  for (const core::Event& event : team.robots[1].recording.events) {
    ends_there = ends_there || core::time_of(event) == 1'270'000'000;
  }
  EXPECT_TRUE(ends_there);
}

TEST_F(MrclamFolder, TellsLandmarksRobotsAndMisreadBarcodesApart) {
  const core::TeamRecording team = read_mrclam(folder_.path());
  EXPECT_EQ(team.misread, 1);
  ASSERT_EQ(team.robots[0].sightings.size(), 1u);
  EXPECT_EQ(team.robots[0].sightings[0].seen, 1);
  ASSERT_EQ(team.robots[1].sightings.size(), 1u);
  EXPECT_EQ(team.robots[1].sightings[0].seen, 0);
  EXPECT_FALSE(team.starts_known);
  std::size_t labelled = 0;
  for (const auto& labels : team.robots[0].recording.labels) labelled += labels.size();
  EXPECT_EQ(labelled, 1u);
}

TEST_F(MrclamFolder, RobotsThatAreNotChosenAreNotSeen) {
  const core::TeamRecording team = read_mrclam(folder_.path(), {2});
  ASSERT_EQ(team.robots.size(), 1u);
  EXPECT_EQ(team.robots[0].number, 2);
  EXPECT_TRUE(team.robots[0].sightings.empty());
}

TEST_F(MrclamFolder, ARobotWithoutSightingsIsLeftOutAndNamed) {
  folder_.write("measurements.csv", "1,0.5,63,6,2.0,0.1\n");
  const core::TeamRecording team = read_mrclam(folder_.path());
  ASSERT_EQ(team.robots.size(), 1u);
  ASSERT_EQ(team.remarks.size(), 1u);
  EXPECT_NE(team.remarks[0].find("robot 2 is left out"), std::string::npos) << team.remarks[0];
}

TEST_F(MrclamFolder, RefusesWhatIsMissingOrContradictsItself) {
  folder_.write("measurements.csv", std::string(sightings) + "2,3.5,77,21,1.0,0.0\n");
  EXPECT_NE(error().find("measurements.csv:6: subject 21 is neither"), std::string::npos) << error();
  folder_.write("measurements.csv", "");
  EXPECT_NE(error().find("robot 1 has no sightings"), std::string::npos) << error();
  folder_.write("measurements.csv", std::string(sightings) + "3,3.5,63,6,1.0,0.0\n");
  EXPECT_NE(error().find("measurements.csv:6: robot 3 has no commands"), std::string::npos) << error();
  folder_.write("measurements.csv", "1,100.5,63,6,2.0,0.1\n2,3.0,63,6,2.0,0.0\n");
  EXPECT_NE(error().find("expected one clock"), std::string::npos) << error();
  folder_.write("measurements.csv", sightings);
  folder_.write("odometry.csv", std::string(commands) + "1,5.0,0.0,0.0\n");
  EXPECT_NE(error().find("odometry.csv:8: robot 1 is here a second time"), std::string::npos) << error();
  folder_.write("odometry.csv", std::string(commands) + "2,9000000.0,0.0,0.0\n");
  EXPECT_NE(error().find("robot 2 has no command from 4.000000 to 9000000.000000 s"), std::string::npos) << error();
  folder_.write("odometry.csv", std::string(commands) + "2,abc,0.0,0.0\n");
  EXPECT_NE(error().find("odometry.csv:8: "), std::string::npos) << error();
  EXPECT_NE(input_error_of([&] { read_mrclam(folder_.path(), {1, 1}); }).find("odometry.csv:8"), std::string::npos);
  folder_.write("odometry.csv", commands);
  EXPECT_NE(input_error_of([&] { read_mrclam(folder_.path(), {1, 1}); }).find("twice"), std::string::npos);
  EXPECT_NE(input_error_of([&] { read_mrclam(folder_.path(), {4}); }).find("no robot 4"), std::string::npos);
  std::filesystem::remove(folder_.path() / "measurements.csv");
  EXPECT_NE(error().find("measurements.csv: expected this file"), std::string::npos) << error();
}

/// Robot 1 drives a circle past four landmarks; bearings may be counted clockwise.
std::string sightings_on_a_circle(double sign) {
  const double landmarks_m[4][2] = {{3.0, 1.0}, {1.0, 4.0}, {-2.0, 2.5}, {0.5, -1.5}};
  std::string rows = "2,3.0,63,6,2.0,0.0\n";
  for (int k = 0; k < 60; ++k) {
    const double t_s = 0.25 * k;
    const core::Pose2 pose(std::sin(0.4 * t_s), 1.0 - std::cos(0.4 * t_s), 0.4 * t_s);
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector2d seen_m =
          core::transform(core::inverse(pose), Eigen::Vector2d(landmarks_m[i][0], landmarks_m[i][1]));
      rows += "1," + std::to_string(t_s) + ",63," + std::to_string(6 + i) + ',' + std::to_string(seen_m.norm()) + ',' +
              std::to_string(sign * std::atan2(seen_m.y(), seen_m.x())) + '\n';
    }
  }
  return rows;
}

TEST_F(MrclamFolder, SaysThatBearingsAreClockwise) {
  folder_.write("odometry.csv", "1,0.0,0.4,0.4\n1,16.0,0.0,0.0\n2,0.0,0.5,0.0\n2,16.0,0.0,0.0\n");
  folder_.write("landmarks_true.csv", "6,0,0,0,0\n7,0,0,0,0\n8,0,0,0,0\n9,0,0,0,0\n");
  MrclamSettings precise;
  precise.looks_as_one = 1.0;
  precise.sigma_range_m = 0.05;
  precise.sigma_bearing_rad = 0.02;
  folder_.write("measurements.csv", sightings_on_a_circle(1.0));
  EXPECT_TRUE(read_mrclam(folder_.path(), {}, precise).remarks.empty());
  folder_.write("measurements.csv", sightings_on_a_circle(-1.0));
  const core::TeamRecording team = read_mrclam(folder_.path(), {}, precise);
  ASSERT_EQ(team.remarks.size(), 1u);
  EXPECT_NE(team.remarks[0].find("robot 1: while the vehicle turns"), std::string::npos) << team.remarks[0];
}

TEST_F(MrclamFolder, IsRecognisedAndNothingElseIs) {
  EXPECT_TRUE(is_mrclam(folder_.path()));
  EXPECT_FALSE(is_mrclam(folder_.path() / "odometry.csv"));
  EXPECT_FALSE(is_mrclam(folder_.path() / "nothing"));
  folder_.write("vehicle.toml", "");
  EXPECT_FALSE(is_mrclam(folder_.path()));
}

class Mrclam6 : public testing::RealDataTest {
 protected:
  void SetUp() override { find_real_data("mrclam"); }
};

TEST_F(Mrclam6, IsTheSameFromTablesAndFromTheOriginalFiles) {
  const core::TeamRecording tables = read_mrclam(path_ / "dataset6");
  const core::TeamRecording original = read_mrclam(path_ / "raw" / "MRCLAM_Dataset6.tar.xz");
  ASSERT_EQ(tables.robots.size(), 5u);
  ASSERT_EQ(original.robots.size(), 5u);
  EXPECT_TRUE(tables.starts_known);
  EXPECT_EQ(tables.misread, 6);
  EXPECT_EQ(original.misread, 6);
  std::size_t landmarks = 0;
  std::size_t robots = 0;
  for (std::size_t r = 0; r < 5; ++r) {
    EXPECT_EQ(tables.robots[r].recording.events.size(), original.robots[r].recording.events.size());
    EXPECT_EQ(tables.robots[r].recording.labels, original.robots[r].recording.labels);
    robots += tables.robots[r].sightings.size();
    for (const auto& labels : tables.robots[r].recording.labels) landmarks += labels.size();
    EXPECT_NEAR(tables.robots[r].recording.start.mean.x_m, original.robots[r].recording.start.mean.x_m, 1e-4);
  }
  EXPECT_EQ(landmarks, 15383u);
  EXPECT_EQ(robots, 3988u);
}

TEST_F(Mrclam6, RunNineHasNoStartsAndItsCommandsAreInOrder) {
  const core::TeamRecording team = read_mrclam(path_ / "dataset9");
  EXPECT_FALSE(team.starts_known);
  EXPECT_EQ(team.remarks.size(), 4u);
  EXPECT_EQ(team.true_landmarks.size(), 15u);
}

}  // namespace
}  // namespace helixnav::logs
