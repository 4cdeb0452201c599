// SPDX-License-Identifier: BSD-3-Clause
#include "placing/relative_covariance.hpp"

#include <Eigen/QR>

namespace helixnav::supervisor {
namespace {

/// Columns: all points moved along x, along y, turned about their middle.
Eigen::MatrixXd common_motions(const std::vector<Eigen::Vector2d>& points_m) {
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point_m : points_m) middle_m += point_m / static_cast<double>(points_m.size());
  Eigen::MatrixXd motions(2 * static_cast<Eigen::Index>(points_m.size()), 3);
  Eigen::Index row = 0;
  for (const Eigen::Vector2d& point_m : points_m) {
    const Eigen::Vector2d d = point_m - middle_m;
    motions.row(row++) << 1.0, 0.0, -d.y();
    motions.row(row++) << 0.0, 1.0, d.x();
  }
  return motions;
}

}  // namespace

std::vector<Eigen::Matrix2d> relative_covariances(const std::vector<Eigen::Vector2d>& points_m,
                                                  const Eigen::Ref<const Eigen::MatrixXd>& P) {
  std::vector<Eigen::Matrix2d> relative(points_m.size(), Eigen::Matrix2d::Zero());
  if (points_m.size() < 2) return relative;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(common_motions(points_m));
  const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(P.rows(), 3);
  const Eigen::MatrixXd left = P - Q * (Q.transpose() * P);
  const Eigen::MatrixXd LQ = left * Q;
  for (std::size_t i = 0; i < relative.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    const Eigen::Matrix2d own = left.block<2, 2>(row, row) - LQ.middleRows<2>(row) * Q.middleRows<2>(row).transpose();
    relative[i] = 0.5 * (own + own.transpose());
  }
  return relative;
}

}  // namespace helixnav::supervisor
