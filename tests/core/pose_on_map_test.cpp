// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/pose_on_map.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "helixnav/core/errors.hpp"

namespace helixnav::core {
namespace {

PoseGaussian start() {
  PoseGaussian pose{Pose2(1.0, -2.0, 0.4), Eigen::Vector3d(0.3, 0.2, 0.01).asDiagonal()};
  pose.covariance(0, 1) = pose.covariance(1, 0) = 0.05;
  pose.covariance(0, 2) = pose.covariance(2, 0) = -0.02;
  return pose;
}

TEST(PoseOnMap, MovesAsTheChainRuleSays) {
  Odometry odometry;
  odometry.T_before_after = Pose2(0.7, 0.1, -0.2);
  odometry.covariance = Eigen::Vector3d(1e-3, 2e-4, 1e-5).asDiagonal();
  PoseOnMap pose(start());
  pose.move(odometry);
  pose.move(odometry);
  Odometry twice;
  twice.T_before_after = start().mean;
  twice.covariance = start().covariance;
  for (int k = 0; k < 2; ++k) {
    const ComposeJacobians J = compose_jacobians(twice.T_before_after, odometry.T_before_after);
    twice.covariance = (J.J_first * twice.covariance * J.J_first.transpose() +
                        J.J_second * odometry.covariance * J.J_second.transpose())
                           .eval();
    twice.T_before_after = compose(twice.T_before_after, odometry.T_before_after);
  }
  EXPECT_LT((pose.mean().vector() - twice.T_before_after.vector()).norm(), 1e-15);
  EXPECT_LT((pose.estimate().covariance - twice.covariance).norm(), 1e-15);
}

TEST(PoseOnMap, UpdatesAsTheInformationFormDoes) {
  const Eigen::Vector2d point_m(6.0, 3.0);
  const Pose2 T_robot_sensor(0.5, 0.2, 0.1);
  PoseOnMap pose(start());
  const Observation z = make_range_bearing(6.9, 0.25, 0.1, 0.02);
  const PredictedObservation predicted = predict_observation(z.kind, start().mean, T_robot_sensor, point_m);
  const Eigen::Matrix3d information =
      start().covariance.inverse() + predicted.H_pose.transpose() * z.R.inverse() * predicted.H_pose;
  const Eigen::Vector3d correction =
      information.inverse() * predicted.H_pose.transpose() * z.R.inverse() * innovation(z.kind, z.z, predicted.z_hat);
  pose.see(z, T_robot_sensor, point_m);
  EXPECT_LT((pose.estimate().covariance - information.inverse()).norm(), 1e-12);
  EXPECT_LT((pose.mean().vector() - start().mean.vector() - correction).norm(), 1e-12);
}

TEST(PoseOnMap, StaysAsItWasWhereTheResultWouldNotBeFinite) {
  PoseOnMap pose(start());
  Odometry odometry;
  odometry.T_before_after.x_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(pose.move(odometry), NumericalError);
  Observation z = make_range(1.0, 0.1);
  z.z[0] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(pose.see(z, {}, {4.0, 0.0}), NumericalError);
  EXPECT_EQ(pose.mean().vector(), start().mean.vector());
  EXPECT_EQ(pose.estimate().covariance, start().covariance);
}

}  // namespace
}  // namespace helixnav::core
