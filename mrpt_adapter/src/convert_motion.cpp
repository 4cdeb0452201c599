// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/mrpt_adapter/conversions.hpp"
#include "matrices.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using mrpt::obs::CActionCollection;
using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CActionRobotMovement3D;

core::Odometry checked(const core::Pose2& mean, const Eigen::Matrix3d& covariance, const std::string& what) {
  if (!mean.vector().allFinite()) throw core::InputError(what + ": its mean is not finite");
  if (!core::is_symmetric_positive_semidefinite(covariance)) {
    throw core::InputError(what + ": its covariance is not symmetric positive semidefinite");
  }
  core::Odometry odometry;
  odometry.T_before_after = mean;
  odometry.covariance = covariance;
  return odometry;
}

core::Pose2 pose_of(const mrpt::poses::CPose2D& pose) { return {pose.x(), pose.y(), pose.phi()}; }

/// A match of scans, or else what is least uncertain; the first of equals. MRPT's own choice passes over all whose
/// covariance has a determinant above 1000.
std::shared_ptr<CActionRobotMovement2D> best_of(const CActionCollection& actions) {
  std::shared_ptr<CActionRobotMovement2D> best;
  double least = 0.0;
  for (const auto& action : actions) {
    auto movement = std::dynamic_pointer_cast<CActionRobotMovement2D>(action.get_ptr());
    if (!movement || !movement->poseChange) continue;
    if (movement->estimationMethod == CActionRobotMovement2D::emScan2DMatching) return movement;
    const double determinant = eigen_of(movement->poseChange->getCovariance()).determinant();
    if (best && !(determinant < least)) continue;
    best = std::move(movement);
    least = determinant;
  }
  return best;
}

}  // namespace

std::optional<core::Odometry> odometry_of(const CActionCollection& actions) {
  if (const auto movement = best_of(actions)) {
    const auto [covariance, mean] = movement->poseChange->getCovarianceAndMean();
    return checked(pose_of(mean), eigen_of(covariance), "CActionRobotMovement2D");
  }
  for (const auto& action : actions) {
    const auto movement = std::dynamic_pointer_cast<CActionRobotMovement3D>(action.get_ptr());
    if (!movement) continue;
    const mrpt::poses::CPose3D& mean = movement->poseChange.mean;
    Eigen::Matrix3d covariance;
    constexpr int planar[] = {0, 1, 3};  // of (x, y, z, yaw, pitch, roll)
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) covariance(r, c) = movement->poseChange.cov(planar[r], planar[c]);
    }
    return checked({mean.x(), mean.y(), mean.yaw()}, covariance, "CActionRobotMovement3D");
  }
  return std::nullopt;
}

core::Odometry increment_between(const mrpt::poses::CPose2D& before, const mrpt::poses::CPose2D& after,
                                 const MapBuilderOptions& options) {
  CActionRobotMovement2D::TMotionModelOptions model;
  model.modelSelection = CActionRobotMovement2D::mmGaussian;
  model.gaussianModel.a1 = options.odo_a1;
  model.gaussianModel.a2 = options.odo_a2;
  model.gaussianModel.a3 = options.odo_a3;
  model.gaussianModel.a4 = options.odo_a4;
  model.gaussianModel.minStdXY = options.odo_min_std_xy;
  model.gaussianModel.minStdPHI = options.odo_min_std_phi_rad;
  const core::Pose2 moved = core::between(pose_of(before), pose_of(after));
  CActionRobotMovement2D movement;
  movement.computeFromOdometry(mrpt::poses::CPose2D(moved.x_m, moved.y_m, moved.heading_rad), model);
  return checked(moved, eigen_of(movement.poseChange->getCovariance()), "CObservationOdometry");
}

}  // namespace helixnav::mrpt_adapter
