// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::pf_relocalize::test {

/// A joint estimate as a filter leaves it after a drive: landmarks along a road share the drift of the pose that saw
/// them (a random walk), each with its own small error; the vehicle has drifted on.
inline core::JointGaussian drive_map(int landmarks, std::uint64_t seed, double drift_m = 0.3, double drift_rad = 0.01) {
  core::RandomStream random(seed, "joint map");
  core::JointGaussian joint;
  const Eigen::Index size = 3 + 2 * landmarks;
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(size, 3 * (landmarks + 1) + 2 * landmarks);
  Eigen::Vector2d road(0.0, 0.0);
  double heading = random.uniform(-3.0, 3.0);
  std::vector<Eigen::Vector2d> stations;
  const auto add_drift = [&](Eigen::Index row, const Eigen::Vector2d& point, std::size_t steps, bool pose) {
    for (std::size_t k = 0; k < steps; ++k) {
      const auto column = static_cast<Eigen::Index>(3 * k);
      const Eigen::Vector2d arm = point - stations[k];
      factor.block<2, 3>(row, column) << drift_m, 0.0, -drift_rad * arm.y(), 0.0, drift_m, drift_rad * arm.x();
      if (pose) factor(row + 2, column + 2) = drift_rad;
    }
  };
  for (int i = 0; i < landmarks; ++i) {
    heading += random.normal(0.0, 0.1);
    road += 4.0 * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    stations.push_back(road);
    joint.ids.push_back(i);
    joint.points_m.emplace_back(road + Eigen::Vector2d(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0)));
    add_drift(3 + 2 * i, joint.points_m.back(), stations.size(), false);
    const double own = random.uniform(0.02, 0.2);
    for (int axis = 0; axis < 2; ++axis) factor(3 + 2 * i + axis, 3 * (landmarks + 1) + 2 * i + axis) = own;
  }
  stations.push_back(road);
  joint.pose = core::Pose2(road.x() + 5.0, road.y() - 3.0, heading);
  add_drift(0, joint.pose.position_m(), stations.size(), true);
  joint.covariance = factor * factor.transpose();
  return joint;
}

}  // namespace helixnav::pf_relocalize::test
