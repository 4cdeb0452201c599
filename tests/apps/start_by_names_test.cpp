// SPDX-License-Identifier: BSD-3-Clause
#include "drive/start_by_names.hpp"

#include <cmath>
#include <variant>

#include <gtest/gtest.h>

#include "helixnav/core/odometry.hpp"

namespace helixnav::apps {
namespace {

constexpr double reach_of_sensor_m = 30.0;
const core::Pose2 T_map_begin(40.0, -7.0, 2.0);

NamedMap map_of_four() {
  NamedMap map;
  const Eigen::Vector2d points_m[] = {{40.0, 3.0}, {32.0, -1.0}, {31.0, 6.0}, {200.0, 0.0}};
  for (int i = 0; i < 4; ++i) {
    map.landmark_of[10 + i] = i;
    map.point_m[i] = points_m[i];
  }
  return map;
}

void drive_on(const core::Pose2& T_before_after, core::Recording& recording) {
  core::Odometry motion = core::no_motion(0);
  motion.T_before_after = T_before_after;
  motion.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  recording.events.emplace_back(motion);
}

/// A scan from that pose; `moved_m`: the first landmark is this far from its place on the map.
void look_from(const core::Pose2& T_map_robot, const std::vector<core::Label>& labels, core::Recording& recording,
               double moved_m = 0.0) {
  core::Scan scan;
  const NamedMap map = map_of_four();
  for (const core::Label label : labels) {
    const auto named = map.landmark_of.find(label);
    Eigen::Vector2d at_m = named == map.landmark_of.end() ? Eigen::Vector2d(50.0, 0.0) : map.point_m.at(named->second);
    if (label == labels.front()) at_m.x() += moved_m;
    const Eigen::Vector2d seen_m = core::transform(core::inverse(T_map_robot), at_m);
    scan.observations.push_back(core::make_range_bearing(seen_m.norm(), std::atan2(seen_m.y(), seen_m.x()), 0.1, 0.01));
  }
  recording.events.emplace_back(scan);
  recording.labels.push_back(labels);
}

void expect_begin(const std::optional<core::PoseGaussian>& start) {
  ASSERT_TRUE(start);
  EXPECT_LT((start->mean.vector() - T_map_begin.vector()).norm(), 1e-9);
}

TEST(StartByNames, IsThatOfTheFirstScanThatTellsThePose) {
  core::Recording recording;
  const core::Pose2 step(1.0, 0.1, 0.3);
  look_from(T_map_begin, {10, 99}, recording);  // one name of the map
  drive_on(step, recording);
  core::Pose2 here = core::compose(T_map_begin, step);
  look_from(here, {10, 11, 12}, recording, 5.0);  // another tree has been given a name of the map
  drive_on(step, recording);
  here = core::compose(here, step);
  look_from(here, {10, 11, 12}, recording);
  const std::optional<core::PoseGaussian> start = start_by_names(recording, map_of_four(), reach_of_sensor_m);
  expect_begin(start);
  const double given_m = reach_of_sensor_m / 60.0;
  EXPECT_GT(start->covariance(0, 0), given_m * given_m) << "what odometry adds";
}

// The session starts as from a given pose; its covariance does not cover a long blind stretch.
TEST(StartByNames, IsNoBeginAfterALongWayUntilTheFirstName) {
  for (const bool is_long : {false, true}) {
    Drive job;
    job.known_association = true;
    job.earlier.emplace();
    job.earlier->landmark_of = map_of_four().landmark_of;
    for (const auto& [id, point_m] : map_of_four().point_m) {
      job.earlier->map.joint.ids.push_back(id);
      job.earlier->map.joint.points_m.push_back(point_m);
    }
    core::Pose2 here = T_map_begin;
    for (int k = 0; k < (is_long ? 400 : 4); ++k) {  // 100 times the variance
      drive_on(core::Pose2(0.01, 0.0, 0.0), job.recording);
      std::get<core::Odometry>(job.recording.events.back()).covariance *= 100.0;
      here = core::compose(here, core::Pose2(0.01, 0.0, 0.0));
    }
    look_from(here, {10, 11, 12}, job.recording);
    EXPECT_EQ(begin_by_names(job).empty(), is_long);
    EXPECT_EQ(job.earlier->start.kind, is_long ? SessionStart::Kind::unknown : SessionStart::Kind::pose);
  }
}

TEST(StartByNames, IsNotToldByLandmarksCloseTogether) {
  core::Recording recording;
  NamedMap map = map_of_four();
  look_from(T_map_begin, {10, 10}, recording);
  EXPECT_FALSE(start_by_names(recording, map, reach_of_sensor_m));
}

TEST(StartByNames, IsNotToldAfterTheVehicleWasCarried) {
  core::Recording recording;
  recording.events.emplace_back(core::Lost{});
  look_from(T_map_begin, {10, 11, 12}, recording);
  EXPECT_FALSE(start_by_names(recording, map_of_four(), reach_of_sensor_m));
}

TEST(StartByNames, ContradictsAtFiveDeviations) {
  const core::PoseGaussian one{core::Pose2(0.0, 0.0, 3.1), Eigen::Matrix3d::Identity() * 0.01};
  core::PoseGaussian other{core::Pose2(0.3, 0.0, -3.1), Eigen::Matrix3d::Zero()};
  EXPECT_FALSE(contradict(one, other));
  other.mean.x_m = 0.6;
  EXPECT_TRUE(contradict(one, other));
}

}  // namespace
}  // namespace helixnav::apps
