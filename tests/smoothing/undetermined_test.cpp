// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/undetermined.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "helixnav/smoothing/optimize.hpp"

namespace helixnav::smoothing {
namespace {

/// A landmark seen by bearings of 1° from 0, 1, 2 and 3 m along x.
core::LandmarkGraph passing(const Eigen::Vector2d& point_m) {
  core::LandmarkGraph graph;
  graph.landmarks.push_back({42, point_m});
  for (int i = 0; i < 4; ++i) {
    graph.poses.push_back({i, core::Pose2(i, 0.0, 0.0)});
    if (i > 0) graph.pose_edges.push_back({i - 1, i, core::Pose2(1.0, 0.0, 0.0), 1e-6 * Eigen::Matrix3d::Identity()});
    const double bearing_rad = std::atan2(point_m.y(), point_m.x() - i);
    graph.landmark_edges.push_back({i, 0, core::Pose2(), core::make_bearing(bearing_rad, 0.0175)});
  }
  return graph;
}

TEST(HardlyDetermined, IsWhatIsSeenFromOneSideByBearingsAlone) {
  EXPECT_EQ(hardly_determined_landmarks(passing({20.0, 0.5})), std::vector<int>{0});
  EXPECT_TRUE(hardly_determined_landmarks(passing({1.5, 4.0})).empty());
}

TEST(HardlyDetermined, IsNothingWithARange) {
  core::LandmarkGraph graph = passing({20.0, 0.5});
  graph.landmark_edges.back().observation = core::make_range_bearing(17.0, 0.0, 5.0, 0.5);
  EXPECT_TRUE(hardly_determined_landmarks(graph).empty());
}

TEST(UndeterminedLandmark, NamesWhatTheSolverLeavesOpen) {
  core::LandmarkGraph graph = passing({20.0, 0.0});
  Problem problem = problem_from_graph(graph);
  try {
    optimize(problem, Options());
    FAIL() << "bearings along a line do not place a landmark on it";
  } catch (const UndeterminedLandmark& error) {
    EXPECT_EQ(error.name, 42);
    EXPECT_NE(std::string(error.what()).find("landmark 42"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace helixnav::smoothing
