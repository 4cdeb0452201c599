// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/evaluation/nees.hpp"

#include <limits>

#include <Eigen/Cholesky>

#include "helixnav/core/angle.hpp"

namespace helixnav::evaluation {

double nees(const core::PoseGaussian& estimate, const core::Pose2& truth) {
  Eigen::Vector3d error = estimate.mean.vector() - truth.vector();
  error.z() = core::wrap_to_pi(error.z());
  const Eigen::LLT<Eigen::Matrix3d> llt(estimate.covariance);
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  return llt.matrixL().solve(error).squaredNorm();
}

}  // namespace helixnav::evaluation
