// SPDX-License-Identifier: BSD-3-Clause
#include "team/last_frames.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace helixnav::apps {
namespace {

team::TeamJoin join_of(int robot, int other, core::Nanoseconds t_ns, const core::Pose2& T) {
  team::TeamJoin join;
  join.robot = robot;
  join.other = other;
  join.t_ns = t_ns;
  join.T_component_other = T;
  return join;
}

void expect_near(const core::Pose2& a, const core::Pose2& b) {
  EXPECT_LT((a.vector() - b.vector()).norm(), 1e-12) << a.vector().transpose() << " | " << b.vector().transpose();
}

const core::Pose2 T_12(3.0, -1.0, 0.7), T_01(5.0, 2.0, -1.1), wrong(-20.0, 9.0, 2.0);

TEST(LastFrames, BringWhatWasToldBeforeAJoinIntoTheLastFrame) {
  LastFrames frames({0, 1, 2});
  const std::size_t none = frames.note({});
  const Joins one{join_of(1, 2, 10, T_12)};
  const std::size_t first = frames.note(one);
  EXPECT_EQ(frames.note(one), first);
  const Joins two{one[0], join_of(0, 1, 20, T_01)};
  const std::size_t last = frames.note(two);
  expect_near(frames.T_end_then(2, none), core::compose(T_01, T_12));
  expect_near(frames.T_end_then(2, first), T_01);
  expect_near(frames.T_end_then(2, last), core::Pose2());
  expect_near(frames.T_end_then(1, none), T_01);
  EXPECT_EQ(frames.since_ns(2), 20);
  EXPECT_EQ(frames.since_ns(0), std::numeric_limits<core::Nanoseconds>::min());
  EXPECT_FALSE(frames.was_taken_back(2, first));
}

TEST(LastFrames, BringWhatWasToldUnderAJoinTakenBackIntoTheRobotsOwn) {
  LastFrames frames({0, 1, 2});
  const std::size_t before = frames.note({});
  const std::size_t held = frames.note({join_of(0, 1, 10, wrong)});
  const std::size_t after = frames.note({});
  expect_near(frames.T_end_then(1, before), core::Pose2());
  expect_near(frames.T_end_then(1, held), core::inverse(wrong));
  expect_near(frames.T_end_then(1, after), core::Pose2());
  EXPECT_TRUE(frames.was_taken_back(1, held));
  EXPECT_FALSE(frames.was_taken_back(0, held));
  EXPECT_EQ(frames.since_ns(1), std::numeric_limits<core::Nanoseconds>::min());
}

/// When everything is reprocessed, the right join may be found at a time at which the wrong one was in force.
TEST(LastFrames, PutTheRightJoinInThePlaceOfTheWrongOne) {
  LastFrames frames({0, 1, 2});
  const std::size_t held = frames.note({join_of(1, 2, 5, T_12), join_of(0, 1, 10, wrong)});
  frames.note({join_of(1, 2, 5, T_12), join_of(0, 1, 8, T_01)});
  expect_near(frames.T_end_then(2, held), core::compose(T_01, core::inverse(wrong)));
  EXPECT_EQ(frames.since_ns(2), 8);
}

}  // namespace
}  // namespace helixnav::apps
