// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "helixnav/core/landmark_graph.hpp"

namespace helixnav::core {
namespace {

using Edge = LandmarkGraph::LandmarkEdge;

constexpr double assumed_range_m = 3.0;

Pose2 sensor_pose(const LandmarkGraph& graph, const Edge& edge) {
  return compose(graph.poses[static_cast<std::size_t>(edge.pose)].T_world_robot, edge.T_robot_sensor);
}

/// Sums of all bearing lines n·(m − c) = 0 of one landmark, and of all its ranges.
struct Crossing {
  Eigen::Matrix2d normal_matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d normal_rhs = Eigen::Vector2d::Zero();
  std::optional<Eigen::Vector2d> along_first_bearing;
  std::vector<Eigen::Vector3d> circles;  ///< centre and range

  void add_bearing(const Pose2& T_world_sensor, double bearing_rad) {
    const double heading = T_world_sensor.heading_rad + bearing_rad;
    const Eigen::Vector2d direction(std::cos(heading), std::sin(heading));
    const Eigen::Vector2d normal(-direction.y(), direction.x());
    normal_matrix += normal * normal.transpose();
    normal_rhs += normal * normal.dot(T_world_sensor.position_m());
    if (!along_first_bearing) along_first_bearing = T_world_sensor.position_m() + assumed_range_m * direction;
  }
};

std::optional<Eigen::Vector2d> where_bearings_cross(const Crossing& crossing) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(crossing.normal_matrix);
  // Smallest eigenvalue over largest is about the squared spread of the bearings: 1e-3 means some two degrees.
  if (!(eigen.eigenvalues()[0] > 1e-3 * eigen.eigenvalues()[1])) return std::nullopt;
  const Eigen::Vector2d coordinates =
      (eigen.eigenvectors().transpose() * crossing.normal_rhs).cwiseQuotient(eigen.eigenvalues());
  return eigen.eigenvectors() * coordinates;
}

/// |m|² − 2 c·m + |c|² = r², linear after subtracting the mean equation.
std::optional<Eigen::Vector2d> where_ranges_meet(const std::vector<Eigen::Vector3d>& circles) {
  if (circles.size() < 2) return std::nullopt;
  const Eigen::Index n = static_cast<Eigen::Index>(circles.size());
  Eigen::MatrixXd A(n, 2);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d& circle = circles[static_cast<std::size_t>(i)];
    A.row(i) = 2.0 * circle.head<2>().transpose();
    b[i] = circle.head<2>().squaredNorm() - circle[2] * circle[2];
  }
  const Eigen::RowVector2d mean = A.colwise().mean();
  const double b_mean = b.mean();
  A.rowwise() -= mean;
  b.array() -= b_mean;
  const Eigen::Vector2d nearest_to_mean = A.completeOrthogonalDecomposition().solve(b - A * (0.5 * mean.transpose()));
  return Eigen::Vector2d(0.5 * mean.transpose() + nearest_to_mean);
}

Eigen::Vector2d located(const Crossing& crossing) {
  if (const auto point = where_bearings_cross(crossing)) return *point;
  if (crossing.along_first_bearing) return *crossing.along_first_bearing;
  return where_ranges_meet(crossing.circles).value_or(Eigen::Vector2d::Zero());
}

}  // namespace

void locate_landmarks(LandmarkGraph& graph) {
  std::vector<char> done(graph.landmarks.size(), 0);
  std::vector<Crossing> crossings(graph.landmarks.size());
  for (const Edge& edge : graph.landmark_edges) {
    const std::size_t i = static_cast<std::size_t>(edge.landmark);
    if (done[i]) continue;
    const Observation& observation = edge.observation;
    if (dimension(observation.kind) == 2) {
      const Pose2& T_world_robot = graph.poses[static_cast<std::size_t>(edge.pose)].T_world_robot;
      graph.landmarks[i].point_m = locate_landmark(observation, T_world_robot, edge.T_robot_sensor).point_world_m;
      done[i] = 1;
    } else if (observation.kind == ObservationKind::bearing) {
      crossings[i].add_bearing(sensor_pose(graph, edge), observation.z[0]);
    } else {
      const Eigen::Vector2d centre = sensor_pose(graph, edge).position_m();
      crossings[i].circles.emplace_back(centre.x(), centre.y(), observation.z[0]);
    }
  }
  for (std::size_t i = 0; i < graph.landmarks.size(); ++i) {
    if (!done[i]) graph.landmarks[i].point_m = located(crossings[i]);
  }
}

}  // namespace helixnav::core
