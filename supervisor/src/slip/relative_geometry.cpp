// SPDX-License-Identifier: BSD-3-Clause
#include "slip/relative_geometry.hpp"

#include <algorithm>
#include <limits>

#include "helixnav/core/observation.hpp"

namespace helixnav::supervisor {
namespace {

using Eigen::Index;

/// ∂r/∂(x, y, heading) of the vehicle, world coordinates.
Eigen::Matrix<double, 2, 3> by_pose(const Eigen::Matrix2d& R_robot_world, const Eigen::Vector2d& point_robot_m) {
  Eigen::Matrix<double, 2, 3> J;
  J << -R_robot_world, Eigen::Vector2d(point_robot_m.y(), -point_robot_m.x());
  return J;
}

}  // namespace

RelativeGeometry::RelativeGeometry(const core::JointGaussian& joint) : ids(joint.ids) {
  const auto n = static_cast<Index>(ids.size());
  const Eigen::Matrix2d R_robot_world = core::rotation(-joint.pose.heading_rad);
  const core::Pose2 T_robot_world = core::inverse(joint.pose);
  for (const Eigen::Vector2d& point_m : joint.points_m) points_m.push_back(core::transform(T_robot_world, point_m));
  covariance_m2.resize(2 * n, 2 * n);
  for (Index i = 0; i < n; ++i) {
    const Eigen::Matrix<double, 2, Eigen::Dynamic> by_all =
        by_pose(R_robot_world, points_m[static_cast<std::size_t>(i)]) * joint.covariance.topRows<3>() +
        R_robot_world * joint.covariance.middleRows<2>(3 + 2 * i);
    for (Index k = 0; k <= i; ++k) {
      const Eigen::Matrix2d block =
          by_all.leftCols<3>() * by_pose(R_robot_world, points_m[static_cast<std::size_t>(k)]).transpose() +
          by_all.middleCols<2>(3 + 2 * k) * R_robot_world.transpose();
      covariance_m2.block<2, 2>(2 * i, 2 * k) = block;
      covariance_m2.block<2, 2>(2 * k, 2 * i) = block.transpose();
    }
  }
}

std::vector<SeenPoint> seen_points(const core::Scan& scan, std::size_t most) {
  std::vector<SeenPoint> seen;
  for (std::size_t i = 0; i < scan.observations.size(); ++i) {
    const core::Observation& observation = scan.observations[i];
    if (core::dimension(observation.kind) != 2) continue;
    const core::LocatedLandmark located = core::locate_landmark(observation, {}, scan.T_robot_sensor);
    seen.push_back({static_cast<int>(i), located.point_world_m,
                    located.G_z * Eigen::Matrix2d(observation.R) * located.G_z.transpose()});
  }
  const Eigen::Vector2d sensor_m = scan.T_robot_sensor.position_m();
  std::stable_sort(seen.begin(), seen.end(), [&](const SeenPoint& a, const SeenPoint& b) {
    return (a.point_m - sensor_m).squaredNorm() < (b.point_m - sensor_m).squaredNorm();
  });
  if (seen.size() > most) seen.resize(most);
  return seen;
}

PairEquations::PairEquations(const RelativeGeometry& geometry, const std::vector<SeenPoint>& seen,
                             const std::vector<PointPair>& pairs, const Eigen::Vector3d& displacement) {
  const auto rows = 2 * static_cast<Index>(pairs.size());
  nu.resize(rows);
  A.resize(rows, 3);
  S.resize(rows, rows);
  const Eigen::Matrix2d turn = core::rotation(-displacement.z());
  for (Index i = 0; i < rows / 2; ++i) {
    const PointPair& pair = pairs[static_cast<std::size_t>(i)];
    const Eigen::Vector2d expected_m = turn * (geometry.points_m[pair.landmark] - displacement.head<2>());
    A.block<2, 2>(2 * i, 0) = -turn;
    A.block<2, 1>(2 * i, 2) = Eigen::Vector2d(expected_m.y(), -expected_m.x());
    nu.segment<2>(2 * i) = seen[pair.seen].point_m - expected_m + A.middleRows<2>(2 * i) * displacement;
    for (Index k = 0; k < rows / 2; ++k) {
      const std::size_t other = pairs[static_cast<std::size_t>(k)].landmark;
      S.block<2, 2>(2 * i, 2 * k) = turn * geometry.covariance_of(pair.landmark, other) * turn.transpose();
    }
    S.block<2, 2>(2 * i, 2 * i) += seen[pair.seen].covariance_m2;
  }
}

double median_spacing_m(const std::vector<Eigen::Vector2d>& points_m) {
  std::vector<double> nearest_m;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    double best_m = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < points_m.size(); ++k) {
      if (i != k) best_m = std::min(best_m, (points_m[i] - points_m[k]).norm());
    }
    nearest_m.push_back(best_m);
  }
  if (nearest_m.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = nearest_m.begin() + static_cast<std::ptrdiff_t>(nearest_m.size() / 2);
  std::nth_element(nearest_m.begin(), middle, nearest_m.end());
  return *middle;
}

}  // namespace helixnav::supervisor
