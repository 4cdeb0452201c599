// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include <Eigen/Dense>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/observation.hpp"

namespace helixnav::bench {

/// Plain EKF over the poses of several robots and all landmarks, associations known: the textbook's, written out dense.
class TeamEkf {
 public:
  explicit TeamEkf(const std::vector<core::Pose2>& starts)
      : x_(3 * static_cast<Eigen::Index>(starts.size())), P_(Eigen::MatrixXd::Zero(x_.size(), x_.size())) {
    for (std::size_t r = 0; r < starts.size(); ++r) x_.segment<3>(row(r)) = starts[r].vector();
  }

  core::PoseGaussian pose(std::size_t robot) const {
    return {core::Pose2(Eigen::Vector3d(x_.segment<3>(row(robot)))), P_.block<3, 3>(row(robot), row(robot))};
  }

  void predict(const core::Odometry& odometry, std::size_t robot) {
    const Eigen::Index at = row(robot);
    const core::Pose2 before = pose(robot).mean;
    const core::ComposeJacobians J = core::compose_jacobians(before, odometry.T_before_after);
    x_.segment<3>(at) = core::compose(before, odometry.T_before_after).vector();
    P_.middleRows(at, 3) = (J.J_first * P_.middleRows(at, 3)).eval();
    P_.middleCols(at, 3) = (P_.middleCols(at, 3) * J.J_first.transpose()).eval();
    P_.block<3, 3>(at, at) += J.J_second * odometry.covariance * J.J_second.transpose();
  }

  void observe(const core::Scan& scan, const std::vector<std::int64_t>& names, std::size_t robot) {
    for (std::size_t j = 0; j < names.size(); ++j) {
      if (names[j] >= 0 && rows_.count(names[j]) == 1) update(scan, j, rows_[names[j]], robot);
    }
    for (std::size_t j = 0; j < names.size(); ++j) {
      if (names[j] >= 0 && rows_.count(names[j]) == 0) rows_[names[j]] = augment(scan, j, robot);
    }
  }

 private:
  static Eigen::Index row(std::size_t robot) { return 3 * static_cast<Eigen::Index>(robot); }

  void update(const core::Scan& scan, std::size_t j, Eigen::Index at, std::size_t robot) {
    const core::Observation& z = scan.observations[j];
    const core::PredictedObservation h =
        core::predict_observation(z.kind, pose(robot).mean, scan.T_robot_sensor, x_.segment<2>(at));
    const Eigen::MatrixXd PHt =
        P_.middleCols(row(robot), 3) * h.H_pose.transpose() + P_.middleCols(at, 2) * h.H_landmark.transpose();
    const Eigen::Matrix2d S = h.H_pose * PHt.middleRows(row(robot), 3) + h.H_landmark * PHt.middleRows(at, 2) + z.R;
    const Eigen::MatrixXd K = PHt * S.inverse();
    x_ += K * core::innovation(z.kind, z.z, h.z_hat);
    P_ -= K * PHt.transpose();
    P_ = 0.5 * (P_ + P_.transpose()).eval();  // asymmetric rounding grows from scan to scan
  }

  Eigen::Index augment(const core::Scan& scan, std::size_t j, std::size_t robot) {
    const core::Observation& z = scan.observations[j];
    const core::LocatedLandmark m = core::locate_landmark(z, pose(robot).mean, scan.T_robot_sensor);
    const Eigen::Index n = x_.size();
    const Eigen::MatrixXd cross = m.G_pose * P_.middleRows(row(robot), 3);
    const Eigen::Matrix2d own =
        cross.middleCols(row(robot), 3) * m.G_pose.transpose() + m.G_z * z.R * m.G_z.transpose();
    x_.conservativeResize(n + 2);
    P_.conservativeResize(n + 2, n + 2);
    x_.tail<2>() = m.point_world_m;
    P_.bottomLeftCorner(2, n) = cross;
    P_.topRightCorner(n, 2) = cross.transpose();
    P_.bottomRightCorner<2, 2>() = own;
    return n;
  }

  Eigen::VectorXd x_;
  Eigen::MatrixXd P_;
  std::map<std::int64_t, Eigen::Index> rows_;
};

}  // namespace helixnav::bench
