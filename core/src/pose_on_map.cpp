// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/pose_on_map.hpp"

#include <sstream>

#include <Eigen/LU>

#include "helixnav/core/errors.hpp"

namespace helixnav::core {

void PoseOnMap::move(const Odometry& odometry) {
  const ComposeJacobians J = compose_jacobians(pose_.mean, odometry.T_before_after);
  PoseGaussian moved;
  moved.mean = compose(pose_.mean, odometry.T_before_after);
  moved.covariance =
      J.J_first * pose_.covariance * J.J_first.transpose() + J.J_second * odometry.covariance * J.J_second.transpose();
  become(moved, "move");
}

void PoseOnMap::see(const Observation& observation, const Pose2& T_robot_sensor, const Eigen::Vector2d& point_m) {
  const PredictedObservation predicted = predict_observation(observation.kind, pose_.mean, T_robot_sensor, point_m);
  using PoseByObs = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 2>;
  const PoseByObs PHt = pose_.covariance * predicted.H_pose.transpose();
  const ObsMatrix S = predicted.H_pose * PHt + observation.R;
  const PoseByObs K = PHt * S.inverse();
  const ObsVector nu = innovation(observation.kind, observation.z, predicted.z_hat);
  const Eigen::Matrix3d P = pose_.covariance - K * PHt.transpose();
  become({Pose2(Eigen::Vector3d(pose_.mean.vector() + K * nu)), 0.5 * (P + P.transpose())}, "see");
}

void PoseOnMap::become(const PoseGaussian& pose, const char* verb) {
  if (!pose.mean.vector().allFinite() || !pose.covariance.allFinite()) {
    std::ostringstream problem;
    problem << "pose on the map: " << verb << " ends in a pose that is not finite, from (" << pose_.mean.x_m << " m, "
            << pose_.mean.y_m << " m, " << pose_.mean.heading_rad << " rad)";
    throw NumericalError(problem.str());
  }
  pose_ = pose;
}

}  // namespace helixnav::core
