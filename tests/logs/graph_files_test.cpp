// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/graph_files.hpp"

#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/dlr.hpp"
#include "helixnav/logs/pose_landmark_text.hpp"
#include "input_error.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

using Graph = core::LandmarkGraph;

Eigen::Matrix3d full_covariance() {
  Eigen::Matrix3d C;
  C << 0.04, 0.01, 0.002, 0.01, 0.09, -0.003, 0.002, -0.003, 0.01;
  return C;
}

/// Three poses, two landmarks; one landmark is named like a pose.
Graph small_graph() {
  Graph graph;
  graph.poses = {{0, {}}, {4, {1.0, 0.1, 0.2}}, {9, {2.0, 0.3, 3.0}}};
  graph.landmarks = {{4, {3.0, 4.0}}, {7, {-1.0, 2.0}}};
  graph.pose_edges = {{0, 1, core::Pose2(1.0, 0.1, 0.2), full_covariance()},
                      {1, 2, core::Pose2(1.1, 0.2, 2.8), 2.0 * full_covariance()}};
  Eigen::Matrix2d C;
  C << 0.5, 0.1, 0.1, 0.3;
  graph.landmark_edges = {{0, 0, {}, core::make_cartesian({3.1, 4.1}, C)},
                          {2, 1, {}, core::make_cartesian({-0.5, 2.5}, 0.5 * C)}};
  return graph;
}

void expect_same(const Graph& a, const Graph& b) {
  ASSERT_EQ(a.poses.size(), b.poses.size());
  ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
  ASSERT_EQ(a.pose_edges.size(), b.pose_edges.size());
  ASSERT_EQ(a.landmark_edges.size(), b.landmark_edges.size());
  for (std::size_t i = 0; i < a.pose_edges.size(); ++i) {
    EXPECT_EQ(a.pose_edges[i].from, b.pose_edges[i].from);
    EXPECT_EQ(a.pose_edges[i].to, b.pose_edges[i].to);
    EXPECT_EQ(a.pose_edges[i].T_from_to.vector(), b.pose_edges[i].T_from_to.vector());
    EXPECT_TRUE(a.pose_edges[i].covariance.isApprox(b.pose_edges[i].covariance, 1e-12));
  }
  for (std::size_t i = 0; i < a.landmark_edges.size(); ++i) {
    EXPECT_EQ(a.landmark_edges[i].pose, b.landmark_edges[i].pose);
    EXPECT_EQ(a.landmark_edges[i].landmark, b.landmark_edges[i].landmark);
    EXPECT_TRUE(a.landmark_edges[i].observation.z.isApprox(b.landmark_edges[i].observation.z, 1e-14));
    EXPECT_TRUE(a.landmark_edges[i].observation.R.isApprox(b.landmark_edges[i].observation.R, 1e-12));
  }
}

TEST(G2o, ReadsBackWhatIsWritten) {
  const helixnav::testing::TemporaryFolder folder;
  Graph graph = small_graph();
  graph.landmark_edges.push_back({1, 1, {}, core::make_bearing(0.7, 0.05)});
  write_g2o(graph, folder.path() / "a.g2o");
  const Graph again = read_g2o(folder.path() / "a.g2o");
  expect_same(graph, again);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.poses[i].name, graph.poses[i].name);
    EXPECT_EQ(again.poses[i].T_world_robot.vector(), graph.poses[i].T_world_robot.vector());
  }
  EXPECT_EQ(again.landmarks[0].name, 4 + 10) << "shifted beyond the last pose, since 4 is a pose too";
  EXPECT_EQ(again.landmarks[1].point_m, graph.landmarks[1].point_m);
}

TEST(G2o, KeepsNamesThatAreApart) {
  const helixnav::testing::TemporaryFolder folder;
  Graph graph = small_graph();
  graph.landmarks[0].name = 5;
  write_g2o(graph, folder.path() / "a.g2o");
  EXPECT_EQ(read_g2o(folder.path() / "a.g2o").landmarks[0].name, 5);
}

TEST(G2o, MovesObservationsIntoTheRobotFrame) {
  const helixnav::testing::TemporaryFolder folder;
  Graph graph = small_graph();
  graph.landmark_edges = {{0, 0, core::Pose2(1.0, 2.0, core::pi / 2), core::make_range_bearing(3.0, 0.0, 0.1, 0.02)}};
  write_g2o(graph, folder.path() / "a.g2o");
  const core::Observation observation = read_g2o(folder.path() / "a.g2o").landmark_edges[0].observation;
  EXPECT_TRUE(observation.z.isApprox(Eigen::Vector2d(1.0, 5.0), 1e-12));
  EXPECT_NEAR(observation.R(1, 1), 0.01, 1e-12);
  EXPECT_NEAR(observation.R(0, 0), 0.0036, 1e-12);
}

TEST(G2o, TakesEdgesBeforeTheirVertices) {
  const helixnav::testing::TemporaryFolder folder;
  const Graph graph = read_g2o(folder.write("a.g2o",
                                            "# comment\nEDGE_SE2_XY 1 2 3 4 1 0 1\nFIX 1\nVERTEX_XY 2 3 4\n"
                                            "VERTEX_SE2 1 0 0 0\n"));
  EXPECT_EQ(graph.landmark_edges.size(), 1u);
}

TEST(G2o, NamesFileAndLineOfWhatIsWrong) {
  const helixnav::testing::TemporaryFolder folder;
  const auto error = [&folder](const std::string& text) {
    const std::filesystem::path path = folder.write("a.g2o", "VERTEX_SE2 1 0 0 0\nVERTEX_XY 2 1 1\n" + text);
    const std::string message = helixnav::testing::input_error_of([&] { read_g2o(path); });
    return message.substr(message.find("a.g2o"));
  };
  EXPECT_EQ(error("EDGE_SE3 1 2\n").substr(0, 32), "a.g2o:3: unknown tag 'EDGE_SE3';");
  EXPECT_EQ(error("VERTEX_XY 1 0 0\n"), "a.g2o:3: vertex 1 is given twice");
  EXPECT_EQ(error("EDGE_SE2_XY 1 3 0 0 1 0 1\n"), "a.g2o:3: there is no VERTEX_XY 3");
  EXPECT_EQ(error("EDGE_SE2 1 2 0 0 0 1 0 0 1 0 1\n"), "a.g2o:3: there is no VERTEX_SE2 2");
  EXPECT_EQ(error("EDGE_SE2_XY 1 2 0 0 1 2 1\n"), "a.g2o:3: the information matrix is not positive definite");
  EXPECT_EQ(error("EDGE_SE2_XY 1 2 0 0 1 0 1 5\n"), "a.g2o:3: more columns than EDGE_SE2_XY has (7 after the tag)");
  EXPECT_NE(error("EDGE_SE2_XY 1 2 0 0 1 0\n").find("a.g2o:3: expected an element of the information"),
            std::string::npos);
}

TEST(ISamAndGtsamText, ReadBackTheSameDrive) {
  const helixnav::testing::TemporaryFolder folder;
  const Graph graph = small_graph();
  write_isam(graph, folder.path() / "isam.txt");
  write_gtsam(graph, folder.path() / "gtsam.txt");
  const core::Recording a = read_pose_landmark_text(folder.path() / "isam.txt", NoiseColumns::square_root_information);
  const core::Recording b = read_pose_landmark_text(folder.path() / "gtsam.txt", NoiseColumns::covariance);
  for (const core::Recording* recording : {&a, &b}) {
    const Graph again = core::graph_from_events(recording->events, recording->labels).graph;
    expect_same(graph, again);
  }
}

TEST(GraphWriters, RefuseWhatTheirFormatCannotHold) {
  const helixnav::testing::TemporaryFolder folder;
  Graph graph = small_graph();
  graph.landmark_edges.push_back({1, 1, core::Pose2(1.0, 0.0, 0.0), core::make_bearing(0.7, 0.05)});
  EXPECT_THROW(write_g2o(graph, folder.path() / "a"), core::InputError);
  EXPECT_THROW(write_isam(graph, folder.path() / "a"), core::InputError);
  graph = small_graph();
  graph.fix_edges.push_back({0, {}});
  EXPECT_THROW(write_gtsam(graph, folder.path() / "a"), core::InputError);
}

TEST(RecordingFromGraph, TellsTheDriveInOrder) {
  Graph graph = small_graph();
  std::swap(graph.pose_edges[0], graph.pose_edges[1]);
  const core::Recording recording = recording_from_graph(graph, "small");
  ASSERT_EQ(recording.events.size(), 5u);
  EXPECT_EQ(recording.labels, (std::vector<std::vector<core::Label>>{{4}, {}, {7}}));
  EXPECT_EQ(std::get<core::Odometry>(recording.events[1]).T_before_after.vector(), Eigen::Vector3d(1.0, 0.1, 0.2));
}

TEST(RecordingFromGraph, RefusesAGraphThatIsNoDrive) {
  Graph graph = small_graph();
  graph.pose_edges.push_back({0, 2, {}, full_covariance()});
  EXPECT_EQ(helixnav::testing::input_error_of([&] { recording_from_graph(graph, "small"); }),
            "small: not the graph of one drive: pose 0 has two odometry edges that leave it");
  graph.pose_edges.resize(1);
  EXPECT_THROW(recording_from_graph(graph, "small"), core::InputError);
}

class G2oFile : public helixnav::testing::RealDataTest {};

TEST_F(G2oFile, OfDlrHasItsCounts) {
  ASSERT_NO_FATAL_FAILURE(find_real_data("dlr/raw/dlr.g2o"));
  if (IsSkipped()) return;
  const Graph graph = read_g2o(path_);
  EXPECT_EQ(graph.poses.size(), 3297u);
  EXPECT_EQ(graph.landmarks.size(), 576u);
  EXPECT_EQ(graph.pose_edges.size(), 3296u);
  EXPECT_EQ(graph.landmark_edges.size(), 14309u);
  EXPECT_EQ(recording_from_graph(graph, "dlr").labels.size(), 3297u);
}

class VicParkFile : public helixnav::testing::RealDataTest {};

TEST_F(VicParkFile, HasItsCountsAndDrivesAhead) {
  ASSERT_NO_FATAL_FAILURE(find_real_data("victoria_park_graph/raw/VicPark_clean_data.mat"));
  if (IsSkipped()) return;
  const core::Recording recording = read_vicpark_clean(path_);
  const core::GraphFromEvents made = core::graph_from_events(recording.events, recording.labels);
  EXPECT_EQ(made.graph.poses.size(), 6899u);
  EXPECT_EQ(made.graph.pose_edges.size(), 6898u);
  EXPECT_EQ(made.graph.landmarks.size(), 299u);
  EXPECT_EQ(made.graph.landmark_edges.size(), 45390u);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& edge : made.graph.pose_edges) sum += edge.T_from_to.position_m();
  EXPECT_NEAR(sum.x(), 4027.0, 5.0);
  EXPECT_LT(std::abs(sum.y()), 10.0);
}

}  // namespace
}  // namespace helixnav::logs
