// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <utility>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/graph_files.hpp"

namespace helixnav::logs {
namespace {

using Graph = core::LandmarkGraph;

/// Indices of the pose edges in driving order.
std::vector<std::size_t> odometry_chain(const Graph& graph, const std::string& name) {
  const std::size_t n = graph.poses.size();
  std::vector<int> edge_from(n, -1);
  std::vector<char> has_predecessor(n, 0);
  const auto fail = [&](int pose, const char* what) {
    throw core::InputError(name + ": not the graph of one drive: pose " +
                           std::to_string(graph.poses[static_cast<std::size_t>(pose)].name) + what);
  };
  for (std::size_t i = 0; i < graph.pose_edges.size(); ++i) {
    const Graph::PoseEdge& edge = graph.pose_edges[i];
    if (edge_from[static_cast<std::size_t>(edge.from)] >= 0) fail(edge.from, " has two odometry edges that leave it");
    if (has_predecessor[static_cast<std::size_t>(edge.to)]) fail(edge.to, " has two odometry edges that lead to it");
    edge_from[static_cast<std::size_t>(edge.from)] = static_cast<int>(i);
    has_predecessor[static_cast<std::size_t>(edge.to)] = 1;
  }
  std::size_t pose = 0;
  while (pose < n && has_predecessor[pose]) ++pose;
  std::vector<std::size_t> chain;
  while (pose < n && edge_from[pose] >= 0) {
    chain.push_back(static_cast<std::size_t>(edge_from[pose]));
    pose = static_cast<std::size_t>(graph.pose_edges[chain.back()].to);
  }
  if (chain.size() + 1 != n) {
    throw core::InputError(name + ": not the graph of one drive: its odometry does not join all poses in one chain");
  }
  return chain;
}

/// Scans at every pose; observations of one pose share one sensor pose.
void add_scan(const Graph& graph, const std::vector<std::size_t>& edges_here, core::Nanoseconds t_ns,
              core::Recording& recording) {
  core::Scan scan;
  scan.t_ns = t_ns;
  scan.field_of_view.max_range_m = 0.0;  // what was not seen from here is unknown
  std::vector<core::Label> labels;
  for (const std::size_t i : edges_here) {
    const Graph::LandmarkEdge& edge = graph.landmark_edges[i];
    if (!labels.empty() && edge.T_robot_sensor.vector() != scan.T_robot_sensor.vector()) {
      throw core::InputError(recording.name + ": two sensor poses at pose " +
                             std::to_string(graph.poses[static_cast<std::size_t>(edge.pose)].name));
    }
    scan.T_robot_sensor = edge.T_robot_sensor;
    scan.observations.push_back(edge.observation);
    labels.push_back(graph.landmarks[static_cast<std::size_t>(edge.landmark)].name);
  }
  recording.events.emplace_back(std::move(scan));
  recording.labels.push_back(std::move(labels));
}

}  // namespace

core::Recording recording_from_graph(const core::LandmarkGraph& graph, std::string name) {
  core::Recording recording;
  recording.name = std::move(name);
  recording.labels_are_given = true;
  if (graph.poses.empty()) throw core::InputError(recording.name + ": a graph without poses");
  const std::vector<std::size_t> chain = odometry_chain(graph, recording.name);
  std::vector<std::vector<std::size_t>> edges_at(graph.poses.size());
  for (std::size_t i = 0; i < graph.landmark_edges.size(); ++i) {
    edges_at[static_cast<std::size_t>(graph.landmark_edges[i].pose)].push_back(i);
  }
  const std::size_t first = chain.empty() ? 0 : static_cast<std::size_t>(graph.pose_edges[chain.front()].from);
  add_scan(graph, edges_at[first], 0, recording);
  for (std::size_t k = 0; k < chain.size(); ++k) {
    const Graph::PoseEdge& edge = graph.pose_edges[chain[k]];
    core::Odometry odometry;
    odometry.t_ns = core::nanoseconds_from_seconds(static_cast<double>(k + 1));
    odometry.T_before_after = edge.T_from_to;
    odometry.covariance = edge.covariance;
    recording.events.emplace_back(odometry);
    add_scan(graph, edges_at[static_cast<std::size_t>(edge.to)], odometry.t_ns, recording);
  }
  return recording;
}

}  // namespace helixnav::logs
