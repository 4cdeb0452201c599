// SPDX-License-Identifier: BSD-3-Clause
#include "placing/place_by_points.hpp"

#include <Eigen/QR>

namespace helixnav::supervisor {

Eigen::Matrix<double, 2, 3> point_by_place(const core::Pose2& T, const Eigen::Vector2d& point_m) {
  const Eigen::Vector2d arm_m = point_m - T.position_m();
  Eigen::Matrix<double, 2, 3> J;
  J << 1.0, 0.0, -arm_m.y(), 0.0, 1.0, arm_m.x();
  return J;
}

Eigen::MatrixXd place_by_points(const core::Pose2& T, const std::vector<Eigen::Vector2d>& points_m) {
  const auto rows = 2 * static_cast<Eigen::Index>(points_m.size());
  Eigen::MatrixXd B(rows, 3);
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    B.middleRows<2>(2 * static_cast<Eigen::Index>(i)) = point_by_place(T, points_m[i]);
  }
  return B.colPivHouseholderQr().solve(Eigen::MatrixXd::Identity(rows, rows));
}

}  // namespace helixnav::supervisor
