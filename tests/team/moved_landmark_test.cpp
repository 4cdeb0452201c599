// SPDX-License-Identifier: BSD-3-Clause
#include "moved_landmark.hpp"

#include <gtest/gtest.h>

namespace helixnav::team {
namespace {

core::PointGaussian place(double x_m, double y_m) { return {{x_m, y_m}, 0.01 * Eigen::Matrix2d::Identity()}; }

/// A robot that sees other things where they should be, `others` of them for each sighting of the landmark.
struct Robot {
  std::size_t number = 0;
  SightingCounts counts;

  void sees_elsewhere(MovedLandmark& landmark, const core::PointGaussian& at, int others = 1) {
    counts.accepted += others;
    ++counts.refused;
    landmark.refuse(number, at, counts);
  }
};

TEST(MovedLandmark, IsSeenFiveTimesAtOneOtherPlace) {
  MovedLandmark landmark;
  Robot robot;
  for (int k = 0; k < 4; ++k) robot.sees_elsewhere(landmark, place(3.0, 0.02 * k));
  EXPECT_FALSE(landmark.has_moved(10, robot.counts));
  robot.sees_elsewhere(landmark, place(3.0, 0.1));
  EXPECT_TRUE(landmark.has_moved(10, robot.counts));
}

TEST(MovedLandmark, SeenOftenWhereItWasNeedsMore) {
  MovedLandmark landmark;
  Robot robot;
  for (int k = 0; k < 24; ++k) robot.sees_elsewhere(landmark, place(3.0, 0.0));
  EXPECT_FALSE(landmark.has_moved(100, robot.counts));
  robot.sees_elsewhere(landmark, place(3.0, 0.0));
  EXPECT_TRUE(landmark.has_moved(100, robot.counts));
}

TEST(MovedLandmark, MisreadNamesAreHereAndThere) {
  MovedLandmark landmark;
  Robot robot;
  for (int k = 0; k < 20; ++k) robot.sees_elsewhere(landmark, place(3.0 * k, 0.0));
  EXPECT_FALSE(landmark.has_moved(10, robot.counts));
}

TEST(MovedLandmark, SeenWhereItShouldBeHasNotMoved) {
  MovedLandmark landmark;
  Robot robot;
  for (int k = 0; k < 20; ++k) {
    robot.sees_elsewhere(landmark, place(3.0, 0.0));
    if (k % 4 == 3) landmark.accept();
  }
  EXPECT_FALSE(landmark.has_moved(10, robot.counts));
}

TEST(MovedLandmark, ARobotThatWasMovedSeesNothingWhereItShouldBe) {
  MovedLandmark landmark;
  Robot robot;
  for (int k = 0; k < 20; ++k) {
    robot.counts.refused += 2;  // others
    robot.sees_elsewhere(landmark, place(3.0, 0.0), 1);
  }
  EXPECT_FALSE(landmark.has_moved(10, robot.counts));
}

TEST(MovedLandmark, TwoRobotsMaySeeItOneAfterTheOther) {
  MovedLandmark landmark;
  Robot first{0, {}}, second{1, {500, 300}};
  for (int k = 0; k < 3; ++k) first.sees_elsewhere(landmark, place(3.0, 0.0));
  for (int k = 0; k < 3; ++k) second.sees_elsewhere(landmark, place(3.1, 0.0));
  EXPECT_TRUE(landmark.has_moved(10, second.counts));
}

}  // namespace
}  // namespace helixnav::team
