// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/residuals.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>

#include "factors.hpp"

namespace helixnav::smoothing {
namespace {

double nis(const Eigen::VectorXd& e, const Eigen::MatrixXd& covariance) { return e.dot(covariance.llt().solve(e)); }

std::vector<Residual> all_residuals(const Problem& problem) {
  const core::LandmarkGraph& graph = problem.graph;
  const auto pose = [&graph](int i) -> const core::Pose2& {
    return graph.poses[static_cast<std::size_t>(i)].T_world_robot;
  };
  std::vector<Residual> residuals;
  for (std::size_t i = 0; i < graph.pose_edges.size(); ++i) {
    const auto& edge = graph.pose_edges[i];
    const Eigen::VectorXd e = -odometry_factor(edge, pose(edge.from), pose(edge.to)).e;
    residuals.push_back({Residual::Kind::odometry, static_cast<int>(i), edge.to, -1, e, nis(e, edge.covariance),
                         "odometry from " + pose_name(problem, edge.from) + " to " + pose_name(problem, edge.to)});
  }
  for (std::size_t i = 0; i < graph.landmark_edges.size(); ++i) {
    const auto& edge = graph.landmark_edges[i];
    const Eigen::Vector2d& point_m = graph.landmarks[static_cast<std::size_t>(edge.landmark)].point_m;
    const auto& z = edge.observation;
    const Eigen::VectorXd e = core::innovation(
        z.kind, z.z, core::predict_observation(z.kind, pose(edge.pose), edge.T_robot_sensor, point_m).z_hat);
    residuals.push_back({Residual::Kind::landmark, static_cast<int>(i), edge.pose, edge.landmark, e, nis(e, z.R),
                         pose_name(problem, edge.pose) + " sees " + landmark_name(problem, edge.landmark)});
  }
  for (std::size_t i = 0; i < graph.fix_edges.size(); ++i) {
    const auto& edge = graph.fix_edges[i];
    const Eigen::VectorXd e = -fix_factor(edge.fix, pose(edge.pose)).e;
    residuals.push_back({Residual::Kind::fix, static_cast<int>(i), edge.pose, -1, e, nis(e, edge.fix.covariance_m2),
                         "fix at " + pose_name(problem, edge.pose)});
  }
  return residuals;
}

double nis_per_row(const Residual& residual) { return residual.nis / static_cast<double>(residual.e.size()); }

}  // namespace

std::vector<Residual> largest_residuals(const Problem& problem, std::size_t count) {
  check_problem(problem);
  std::vector<Residual> residuals = all_residuals(problem);
  const auto kept = static_cast<std::ptrdiff_t>(std::min(count, residuals.size()));
  std::partial_sort(residuals.begin(), residuals.begin() + kept, residuals.end(),
                    [](const Residual& a, const Residual& b) { return nis_per_row(a) > nis_per_row(b); });
  residuals.erase(residuals.begin() + kept, residuals.end());
  return residuals;
}

}  // namespace helixnav::smoothing
