// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/settled_log.hpp"

#include <gtest/gtest.h>

namespace helixnav::apps {
namespace {

core::Scan scan_of(core::Nanoseconds t_ns, const core::Observation& observation) {
  core::Scan scan;
  scan.t_ns = t_ns;
  scan.observations = {observation};
  return scan;
}

/// A landmark is 0.5 m ahead and, by a wrong match, also ahead as seen from 1 m on: its best fit is just in front of
/// that sensor.
core::Recording contradiction() {
  core::Recording recording;
  core::Odometry metre;
  metre.t_ns = 1'000'000'000;
  metre.T_before_after = core::Pose2(1.0, 0.0, 0.0);
  metre.covariance = 1e-10 * Eigen::Matrix3d::Identity();
  recording.events = {scan_of(0, core::make_range_bearing(0.5, 0.0, 0.01, 0.01)), metre,
                      scan_of(metre.t_ns, core::make_range_bearing(2.0, 0.0, 10.0, 0.001))};
  return recording;
}

TEST(SolveLog, LeavesOutWhatPutsALandmarkIntoItsSensor) {
  const Ids ids = {{7}, {7}};
  core::LandmarkGraph from;
  from.landmarks.resize(1);
  from.landmarks[0].name = 7;
  from.landmarks[0].point_m = Eigen::Vector2d(1.5, 0.0);
  const SmoothingTask task = solve_log(contradiction(), ids, from);
  EXPECT_EQ(task.edge_of, (std::vector<std::vector<int>>{{0}, {-1}}));
  ASSERT_EQ(task.problem.graph.landmarks.size(), 1u);
  EXPECT_NEAR(task.problem.graph.landmarks[0].point_m.x(), 0.5, 1e-6);
}

}  // namespace
}  // namespace helixnav::apps
