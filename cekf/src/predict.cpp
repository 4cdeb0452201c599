// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>

#include <Eigen/LU>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {
namespace {

/// Positive semidefinite 3×3 by its principal minors, to round-off; no allocation.
bool is_covariance(const Eigen::Matrix3d& Q) {
  if (!Q.allFinite()) return false;
  const double scale = Q.cwiseAbs().maxCoeff();
  const double tiny = 1e-9 * scale;
  if ((Q - Q.transpose()).cwiseAbs().maxCoeff() > tiny || Q.diagonal().minCoeff() < -tiny) return false;
  const auto minor = [&](int i, int j) { return Q(i, i) * Q(j, j) - Q(i, j) * Q(j, i); };
  const double least = -tiny * scale;
  return minor(0, 1) >= least && minor(0, 2) >= least && minor(1, 2) >= least && Q.determinant() >= least * scale;
}

}  // namespace

void CompressedEkf::predict(const core::Odometry& odometry) {
  if (!odometry.T_before_after.vector().allFinite() || !is_covariance(odometry.covariance)) {
    std::ostringstream problem;
    problem << "predict: odometry at t_ns = " << odometry.t_ns << " is not finite or its covariance is no covariance";
    throw core::PreconditionError(problem.str());
  }
  const core::ComposeJacobians J = core::compose_jacobians(active_.pose, odometry.T_before_after);
  auto P = active_.P.view();
  auto A = active_.A.view();
  // F differs from the identity in the heading's column only.
  for (int axis = 0; axis < 2; ++axis) {
    const double f = J.J_first(axis, 2);
    P.col(axis) += f * P.col(2);
    A.col(axis) += f * A.col(2);
  }
  for (int axis = 0; axis < 2; ++axis) P.row(axis) += J.J_first(axis, 2) * P.row(2);
  Eigen::Matrix3d P_vv = P.topLeftCorner<3, 3>() + J.J_second * odometry.covariance * J.J_second.transpose();
  P.topLeftCorner<3, 3>() = 0.5 * (P_vv + P_vv.transpose());
  P.topRightCorner(3, P.cols() - 3) = P.bottomLeftCorner(P.rows() - 3, 3).transpose();
  active_.pose = core::compose(active_.pose, odometry.T_before_after);
}

}  // namespace helixnav::cekf
