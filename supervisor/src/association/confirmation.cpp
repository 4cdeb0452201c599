// SPDX-License-Identifier: BSD-3-Clause
#include "association/confirmation.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double agree_probability = 0.99;  // of two sightings of one landmark

Eigen::Matrix2d absolute(const Eigen::Matrix2d& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(0.5 * (A + A.transpose()));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseAbs().asDiagonal() * eigen.eigenvectors().transpose();
}

/// What is driven in between adds to the pose's covariance, and what corrects the pose meanwhile moves it by what it takes away.
bool agree(const IsolatedHit& a, const IsolatedHit& b) {
  const Eigen::Matrix2d covariance = a.seen_m2 + b.seen_m2 + absolute(b.from_m2 - a.from_m2);
  const Eigen::Vector2d apart_m = b.point_world_m - a.point_world_m;
  static const double gate = core::chi2_quantile(agree_probability, 2);
  return apart_m.dot(covariance.inverse() * apart_m) < gate;
}

}  // namespace

IsolatedHit isolated_hit(core::LandmarkId landmark, double path_m, const core::Observation& seen,
                         const core::PoseGaussian& pose, const core::Pose2& T_robot_sensor) {
  const core::LocatedLandmark located = core::locate_landmark(seen, pose.mean, T_robot_sensor);
  return {landmark, path_m, located.point_world_m, located.G_z * Eigen::Matrix2d(seen.R) * located.G_z.transpose(),
          located.G_pose * pose.covariance * located.G_pose.transpose()};
}

bool Confirmation::confirms(const IsolatedHit& hit, double reach_m) {
  const bool again =
      last_ && last_->landmark == hit.landmark && hit.path_m - last_->path_m <= reach_m && agree(*last_, hit);
  last_ = hit;
  return again;
}

}  // namespace helixnav::supervisor
