// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/landmark_graph.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::core {
namespace {

Odometry step(double x_m, double turn_rad) {
  Odometry odometry;
  odometry.T_before_after = Pose2(x_m, 0.0, turn_rad);
  odometry.covariance = 0.01 * Eigen::Matrix3d::Identity();
  return odometry;
}

Scan scan_of(std::vector<Observation> observations) {
  Scan scan;
  scan.observations = std::move(observations);
  return scan;
}

Observation cartesian(double x_m, double y_m) { return make_cartesian({x_m, y_m}, Eigen::Matrix2d::Identity()); }

TEST(GraphFromEvents, OpensAPoseForEveryScanThatFollowsMotion) {
  const std::vector<Event> events{
      scan_of({}),    step(1.0, 0.0), step(1.0, pi / 2), scan_of({cartesian(1.0, 0.0)}), scan_of({cartesian(2.0, 0.0)}),
      step(1.0, 0.0), AbsoluteFix(),  step(5.0, 0.0)};
  const GraphFromEvents made = graph_from_events(events, {{}, {7}, {-1}});
  ASSERT_EQ(made.graph.poses.size(), 3u);
  EXPECT_EQ(made.pose_of_scan, (std::vector<int>{0, 1, 1}));
  EXPECT_EQ(made.unlabelled_observations, 1);
  EXPECT_EQ(made.graph.fix_edges[0].pose, 2);
  EXPECT_NEAR(made.graph.poses[1].T_world_robot.x_m, 2.0, 1e-15);
  ASSERT_EQ(made.graph.landmarks.size(), 1u);
  EXPECT_EQ(made.graph.landmarks[0].name, 7);
  EXPECT_TRUE(made.graph.landmarks[0].point_m.isApprox(Eigen::Vector2d(2.0, 1.0), 1e-12));
  EXPECT_GT(made.graph.pose_edges[0].covariance(1, 1), 0.02);  // two increments chained
}

TEST(GraphFromEvents, LeavesOutALandmarkThatOneBearingCannotPlace) {
  const std::vector<Event> events{scan_of({make_bearing(0.1, 0.01), cartesian(1.0, 1.0)})};
  const GraphFromEvents made = graph_from_events(events, {{3, 5}});
  EXPECT_EQ(made.unlocated_landmarks, 1);
  ASSERT_EQ(made.graph.landmarks.size(), 1u);
  EXPECT_EQ(made.graph.landmarks[0].name, 5);
  EXPECT_EQ(made.graph.landmark_edges[0].landmark, 0);
}

TEST(GraphFromEvents, RefusesIdsThatDoNotFit) {
  const std::vector<Event> events{scan_of({cartesian(1.0, 1.0)})};
  EXPECT_THROW(graph_from_events(events, {{}}), PreconditionError);
  EXPECT_THROW(graph_from_events(events, {}), PreconditionError);
  EXPECT_THROW(graph_from_events(events, {{1}, {}}), PreconditionError);
}

LandmarkGraph graph_seeing(const Eigen::Vector2d& point_m, ObservationKind kind) {
  LandmarkGraph graph;
  graph.landmarks = {{1, {0.0, 0.0}}};
  const Pose2 T_robot_sensor(0.3, 0.1, 0.5);
  for (int i = 0; i < 6; ++i) {
    graph.poses.push_back({i, Pose2(i, 0.3 * i * i, 0.2 * i)});
    Observation observation = kind == ObservationKind::bearing ? make_bearing(0.0, 0.01) : make_range(1.0, 0.1);
    observation.z = predict_observation(kind, graph.poses.back().T_world_robot, T_robot_sensor, point_m).z_hat;
    graph.landmark_edges.push_back({i, 0, T_robot_sensor, observation});
  }
  return graph;
}

TEST(LocateLandmarks, FindsWhereBearingsCrossAndWhereRangesMeet) {
  const Eigen::Vector2d point_m(4.0, -7.0);
  for (const ObservationKind kind : {ObservationKind::bearing, ObservationKind::range}) {
    LandmarkGraph graph = graph_seeing(point_m, kind);
    locate_landmarks(graph);
    EXPECT_LE((graph.landmarks[0].point_m - point_m).norm(), 1e-9);
  }
}

TEST(LocateLandmarks, GoesAlongParallelBearings) {
  LandmarkGraph graph;
  graph.poses = {{0, {}}, {1, {1.0, 0.0, 0.0}}};
  graph.landmarks = {{1, {0.0, 0.0}}};
  graph.landmark_edges = {{0, 0, {}, make_bearing(0.0, 0.01)}, {1, 0, {}, make_bearing(0.0, 0.01)}};
  locate_landmarks(graph);
  EXPECT_TRUE(graph.landmarks[0].point_m.isApprox(Eigen::Vector2d(3.0, 0.0)));
}

}  // namespace
}  // namespace helixnav::core
