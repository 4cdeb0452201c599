// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/problem.hpp"

#include <algorithm>
#include <utility>

namespace helixnav::smoothing {

Problem problem_from_graph(core::LandmarkGraph graph) {
  Problem problem;
  problem.graph = std::move(graph);
  if (!problem.graph.poses.empty()) problem.fixed_poses.push_back(0);
  return problem;
}

Problem build_problem(const std::vector<core::Event>& events, const std::vector<std::vector<std::int64_t>>& ids,
                      const core::Pose2& start) {
  return problem_from_graph(core::graph_from_events(events, ids, start).graph);
}

void soften_odometry(Problem& problem, const Eigen::Vector3d& sigma) {
  for (core::LandmarkGraph::PoseEdge& edge : problem.graph.pose_edges) {
    edge.covariance.diagonal() += sigma.cwiseAbs2();
  }
}

int degrees_of_freedom(const Problem& problem) {
  const core::LandmarkGraph& graph = problem.graph;
  std::vector<int> fixed = problem.fixed_poses;
  std::sort(fixed.begin(), fixed.end());
  const auto n_fixed = std::unique(fixed.begin(), fixed.end()) - fixed.begin();
  std::size_t rows = 3 * (graph.pose_edges.size() + problem.pose_priors.size()) +
                     2 * (graph.fix_edges.size() + problem.landmark_priors.size());
  for (const auto& edge : graph.landmark_edges) {
    rows += static_cast<std::size_t>(core::dimension(edge.observation.kind));
  }
  const std::size_t columns = 3 * (graph.poses.size() - static_cast<std::size_t>(n_fixed)) + 2 * graph.landmarks.size();
  return static_cast<int>(rows) - static_cast<int>(columns);
}

std::string pose_name(const Problem& problem, int pose) {
  return "pose " + std::to_string(problem.graph.poses.at(static_cast<std::size_t>(pose)).name);
}

std::string landmark_name(const Problem& problem, int landmark) {
  return "landmark " + std::to_string(problem.graph.landmarks.at(static_cast<std::size_t>(landmark)).name);
}

}  // namespace helixnav::smoothing
