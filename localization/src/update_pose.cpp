// SPDX-License-Identifier: BSD-3-Clause
#include "update_pose.hpp"

#include <algorithm>
#include <string>

#include <Eigen/Cholesky>

#include "helixnav/core/errors.hpp"

namespace helixnav::localization {
namespace {

/// ν, H and R of all sightings, stacked.
struct Stacked {
  Eigen::VectorXd nu;
  Eigen::Matrix<double, Eigen::Dynamic, 3> H;
  Eigen::MatrixXd R;
};

Stacked stack(const core::Pose2& pose, const core::Pose2& T_robot_sensor, const std::vector<Sighting>& sightings) {
  Eigen::Index rows = 0;
  for (const Sighting& sighting : sightings) rows += core::dimension(sighting.observation->kind);
  Stacked all{Eigen::VectorXd(rows), Eigen::Matrix<double, Eigen::Dynamic, 3>(rows, 3),
              Eigen::MatrixXd::Zero(rows, rows)};
  Eigen::Index row = 0;
  for (const Sighting& sighting : sightings) {
    const core::Observation& observation = *sighting.observation;
    core::check_observation(observation);
    const core::PredictedObservation predicted =
        core::predict_observation(observation.kind, pose, T_robot_sensor, sighting.point_m);
    const Eigen::Index d = core::dimension(observation.kind);
    all.nu.segment(row, d) = core::innovation(observation.kind, observation.z, predicted.z_hat);
    all.H.middleRows(row, d) = predicted.H_pose;
    all.R.block(row, row, d, d) = observation.R;
    row += d;
  }
  return all;
}

[[noreturn]] void fail(const char* what, const std::vector<Sighting>& sightings, std::int64_t step) {
  std::string message = "localizer: " + std::string(what) + " in step " + std::to_string(step) + ", landmarks";
  for (const Sighting& sighting : sightings) message += ' ' + std::to_string(sighting.landmark);
  throw core::NumericalError(message);
}

}  // namespace

PoseUpdate update_pose(const core::PoseGaussian& pose, const core::Pose2& T_robot_sensor,
                       const std::vector<Sighting>& sightings, std::int64_t step) {
  if (sightings.empty()) return {pose, 0.0, 0};
  const Stacked all = stack(pose.mean, T_robot_sensor, sightings);
  const Eigen::MatrixXd PHt = pose.covariance * all.H.transpose();
  const Eigen::MatrixXd innovations = all.H * PHt + all.R;
  const Eigen::LLT<Eigen::MatrixXd> S(innovations);
  if (S.info() != Eigen::Success) fail("the innovation covariance is not positive definite", sightings, step);
  const Eigen::MatrixXd K = S.solve(PHt.transpose()).transpose();
  const Eigen::Vector3d corrected = pose.mean.vector() + K * all.nu;
  const Eigen::Matrix3d I_KH = Eigen::Matrix3d::Identity() - K * all.H;
  const Eigen::Matrix3d P = I_KH * pose.covariance * I_KH.transpose() + K * all.R * K.transpose();
  if (!corrected.allFinite() || !P.allFinite()) fail("the correction is not finite", sightings, step);
  PoseUpdate updated;
  updated.pose.mean = core::Pose2(corrected);
  updated.pose.covariance = 0.5 * (P + P.transpose());
  updated.nis = all.nu.dot(S.solve(all.nu));
  updated.dof = static_cast<int>(all.nu.size());
  const Eigen::ArrayXd root = S.matrixLLT().diagonal().array();
  updated.numerics.least_pivot = std::min(1.0, (root * root / innovations.diagonal().array()).minCoeff());
  return updated;
}

}  // namespace helixnav::localization
