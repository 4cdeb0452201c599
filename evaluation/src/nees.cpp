// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/evaluation/nees.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "helixnav/core/angle.hpp"

namespace helixnav::evaluation {

double nees(const core::PoseGaussian& estimate, const core::Pose2& truth) {
  Eigen::Vector3d error = estimate.mean.vector() - truth.vector();
  error.z() = core::wrap_to_pi(error.z());
  constexpr double singular = 1e-10;  // as a share of a variance: what is left of it, the others known
  const Eigen::Vector3d sigma = estimate.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  if (!(sigma.minCoeff() > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d weight = sigma.cwiseInverse();
  const Eigen::LLT<Eigen::Matrix3d> llt(weight.asDiagonal() * estimate.covariance * weight.asDiagonal());
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  if (llt.matrixLLT().diagonal().minCoeff() < std::sqrt(singular)) return std::numeric_limits<double>::quiet_NaN();
  return llt.matrixL().solve(error.cwiseProduct(weight)).squaredNorm();
}

}  // namespace helixnav::evaluation
