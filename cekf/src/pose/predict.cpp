// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>
#include <string>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {
namespace {

/// F differs from the identity in the heading's column only: columns, then rows, of x and y.
template <class Covariance>
void carry_columns(const core::ComposeJacobians& J, Covariance&& P) {
  for (int axis = 0; axis < 2; ++axis) P.col(axis) += J.J_first(axis, 2) * P.col(2);
}
template <class Covariance>
void carry_rows(const core::ComposeJacobians& J, Covariance&& P) {
  for (int axis = 0; axis < 2; ++axis) P.row(axis) += J.J_first(axis, 2) * P.row(2);
}

void check_predicted(const core::Pose2& pose, const Eigen::Matrix3d& P, core::Nanoseconds t_ns) {
  constexpr double rounding = 1e-18;  // a covariance of rank two may come out so
  if (pose.vector().allFinite() && P.allFinite() && P.diagonal().minCoeff() >= -rounding) return;
  std::ostringstream problem;
  problem << "predict: at t_ns = " << t_ns << " the pose would be (" << pose.x_m << " m, " << pose.y_m << " m, "
          << pose.heading_rad << " rad) with variances " << P(0, 0) << " m2, " << P(1, 1) << " m2, " << P(2, 2)
          << " rad2";
  throw core::NumericalError(problem.str());
}

}  // namespace

void CompressedEkf::predict(const core::Odometry& odometry) {
  try {
    core::check(odometry);
  } catch (const core::PreconditionError& error) {
    throw core::PreconditionError(std::string("predict: ") + error.what());
  }
  const core::ComposeJacobians J = core::compose_jacobians(active_.pose, odometry.T_before_after);
  const core::Pose2 pose = core::compose(active_.pose, odometry.T_before_after);
  auto P = active_.P.view();
  Eigen::Matrix3d P_vv = P.topLeftCorner<3, 3>();
  carry_columns(J, P_vv);
  carry_rows(J, P_vv);
  P_vv += J.J_second * odometry.covariance * J.J_second.transpose();
  P_vv = (0.5 * (P_vv + P_vv.transpose())).eval();
  check_predicted(pose, P_vv, odometry.t_ns);

  carry_columns(J, P);
  carry_columns(J, active_.A.view());
  P.topLeftCorner<3, 3>() = P_vv;
  P.topRightCorner(3, P.cols() - 3) = P.bottomLeftCorner(P.rows() - 3, 3).transpose();
  active_.pose = pose;
}

}  // namespace helixnav::cekf
