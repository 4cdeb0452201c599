// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/undetermined.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "helixnav/core/observation.hpp"

namespace helixnav::smoothing {
namespace {

/// What all observations of a landmark say about it, given the poses.
struct Known {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  double distances_m = 0.0;
  int observations = 0;

  bool is_hardly_determined() const {
    constexpr double most_share = 0.2;
    const double least =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(information, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
    const double most_sigma_m = most_share * distances_m / observations;
    return !(least * most_sigma_m * most_sigma_m > 1.0);
  }
};

void add_edge(const core::LandmarkGraph& graph, const core::LandmarkGraph::LandmarkEdge& edge, Known& known) {
  const core::Pose2& T_world_robot = graph.poses[static_cast<std::size_t>(edge.pose)].T_world_robot;
  const Eigen::Vector2d& point_m = graph.landmarks[static_cast<std::size_t>(edge.landmark)].point_m;
  const double distance_m = (point_m - core::compose(T_world_robot, edge.T_robot_sensor).position_m()).norm();
  constexpr double nearest_m = 1e-3;  // nothing is seen from this close
  known.distances_m += distance_m;
  ++known.observations;
  if (!(distance_m > nearest_m)) return;
  const auto predicted = core::predict_observation(edge.observation.kind, T_world_robot, edge.T_robot_sensor, point_m);
  const Eigen::MatrixXd H = predicted.H_landmark;
  const Eigen::MatrixXd R = edge.observation.R;
  known.information += H.transpose() * R.llt().solve(H);
}

}  // namespace

std::vector<int> hardly_determined_landmarks(const core::LandmarkGraph& graph) {
  std::vector<Known> known(graph.landmarks.size());
  std::vector<bool> is_placed(graph.landmarks.size(), false);  // by one observation alone
  for (const auto& edge : graph.landmark_edges) {
    const auto landmark = static_cast<std::size_t>(edge.landmark);
    if (core::dimension(edge.observation.kind) == 2) is_placed[landmark] = true;
    if (!is_placed[landmark]) add_edge(graph, edge, known[landmark]);
  }
  std::vector<int> found;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (!is_placed[i] && known[i].is_hardly_determined()) found.push_back(static_cast<int>(i));
  }
  return found;
}

}  // namespace helixnav::smoothing
