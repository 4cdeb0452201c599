// SPDX-License-Identifier: BSD-3-Clause
#include "search/may_be_seen.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::supervisor {
namespace {

core::Pose2 pose_within(core::RandomStream& random, double side_m) {
  return {side_m * random.uniform(), side_m * random.uniform(), 6.0 * random.uniform()};
}

/// Wherever the branch may be, the views that are kept cover as much of it as all views do.
TEST(MayBeSeen, LeavesOutOnlyViewsThatShowNothingOfTheBranch) {
  core::RandomStream random(11);
  int left_out = 0;
  int covered = 0;
  for (int round = 0; round < 20; ++round) {
    pf_relocalize::Coverage all;
    all.field_of_view.max_range_m = 30.0;
    all.field_of_view.min_bearing_rad = -1.5;
    all.field_of_view.max_bearing_rad = 1.5;
    for (int i = 0; i < 300; ++i) all.T_frame_sensor.push_back(pose_within(random, 1000.0));
    std::vector<pf_relocalize::BranchLandmark> branch(12);
    for (pf_relocalize::BranchLandmark& one : branch) one.point_robot_m = pose_within(random, 60.0).position_m();
    MayBeSeen may_be(branch, all.field_of_view.max_range_m);
    std::vector<core::Pose2> hypotheses;
    for (int i = 0; i < 8; ++i) {
      hypotheses.push_back(pose_within(random, 300.0));
      may_be.add(hypotheses.back().position_m());
    }
    pf_relocalize::Coverage kept = all;
    kept.T_frame_sensor.clear();
    for (const core::Pose2& pose : all.T_frame_sensor) {
      if (may_be.seen_from(pose.position_m())) kept.T_frame_sensor.push_back(pose);
    }
    left_out += static_cast<int>(all.T_frame_sensor.size() - kept.T_frame_sensor.size());
    for (const core::Pose2& T_world_robot : hypotheses) {
      for (const pf_relocalize::BranchLandmark& one : branch) {
        const Eigen::Vector2d point_m = core::transform(T_world_robot, one.point_robot_m);
        EXPECT_EQ(kept.covers(point_m), all.covers(point_m));
        covered += all.covers(point_m) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(left_out, 3000);
  EXPECT_GT(covered, 100);
}

TEST(MayBeSeen, IsNothingWithoutAHypothesis) { EXPECT_FALSE(MayBeSeen({}, 30.0).seen_from({0.0, 0.0})); }

}  // namespace
}  // namespace helixnav::supervisor
