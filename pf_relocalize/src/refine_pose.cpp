// SPDX-License-Identifier: BSD-3-Clause
#include "refine_pose.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace helixnav::pf_relocalize {

core::Pose2 refine_pose(const LandmarkTable& table, const std::vector<RobotPoint>& points, double density_ratio_m2,
                        double soften_m, const core::Pose2& pose) {
  const Eigen::Matrix2d rotation = core::rotation(pose.heading_rad);
  Eigen::Matrix3d information = 1e-6 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const RobotPoint& point : points) {
    const Eigen::Vector2d arm = rotation * point.mean_m, placed = pose.position_m() + arm;
    Eigen::Matrix2d noise = rotation * point.covariance_m2 * rotation.transpose();
    noise.diagonal().array() += soften_m * soften_m;
    Eigen::Matrix<double, 2, 3> J;
    J << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
    double total = 1.0;
    Eigen::Matrix2d weights = Eigen::Matrix2d::Zero();
    Eigen::Vector2d pull = Eigen::Vector2d::Zero();
    constexpr double sigmas = 3.5;
    const double noise_m2 = largest_variance(noise);
    const double reach_m = sigmas * std::sqrt(noise_m2 + table.largest);
    const Eigen::Vector2d reach(reach_m, reach_m);
    table.grid.visit(placed - reach, placed + reach, [&](std::uint32_t i) {
      const Eigen::Vector2d d(table.x[i] - placed.x(), table.y[i] - placed.y());
      if (d.squaredNorm() > sigmas * sigmas * (noise_m2 + table.variance[i])) return;
      Eigen::Matrix2d S = noise;
      S(0, 0) += table.sxx[i];
      S(1, 1) += table.syy[i];
      S(0, 1) += table.sxy[i];
      S(1, 0) += table.sxy[i];
      const Eigen::Matrix2d W = S.inverse();
      const double value =
          density_ratio_m2 * std::exp(-0.5 * d.dot(W * d)) * std::sqrt(W.determinant()) / (2.0 * core::pi);
      total += value;
      weights += value * W;
      pull += value * (W * d);
    });
    information += J.transpose() * weights * J / total;
    force += J.transpose() * pull / total;
  }
  return core::Pose2(pose.vector() + information.ldlt().solve(force));
}

}  // namespace helixnav::pf_relocalize
