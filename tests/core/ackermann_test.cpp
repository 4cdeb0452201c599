// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/ackermann.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "central_differences.hpp"
#include "random_states.hpp"

namespace helixnav::core {
namespace {

using testing::states;

/// Speeds and steering angles of a truck; every third sample is straight or nearly so: the arc's series takes over.
AckermannSample random_sample(RandomStream& random) {
  const double steering_rad = random.below(3) == 0
                                  ? random.uniform(-1.0, 1.0) * std::pow(10.0, -random.uniform(1.0, 9.0))
                                  : random.uniform(-0.7, 0.7);
  return {random.uniform(-8.0, 8.0), steering_rad, random.uniform(0.01, 1.0)};
}

/// The same motion integrated in many small steps (midpoint rule) from the differential equations at the rear axle.
Eigen::Vector3d integrate(const AckermannGeometry& g, const AckermannSample& sample, int steps) {
  const double speed_mps =
      sample.wheel_speed_mps / (1.0 - g.encoder_offset_m / g.wheelbase_m * std::tan(sample.steering_rad));
  const double turn_rate = speed_mps / g.wheelbase_m * std::tan(sample.steering_rad);
  const double dt = sample.duration_s / steps;
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  for (int i = 0; i < steps; ++i) {
    const double middle_rad = pose.z() + 0.5 * turn_rate * dt;
    pose += dt * Eigen::Vector3d(speed_mps * std::cos(middle_rad), speed_mps * std::sin(middle_rad), turn_rate);
  }
  return pose;
}

TEST(Ackermann, ArcEqualsFineIntegration) {
  RandomStream random(1, "ackermann");
  const AckermannGeometry geometry;
  for (int i = 0; i < states; ++i) {
    const AckermannSample sample = random_sample(random);
    const Eigen::Vector3d arc = ackermann_increment(geometry, {}, sample).T_before_after.vector();
    EXPECT_LT(testing::pose_difference(arc, integrate(geometry, sample, 4000)).norm(), 3e-7);
  }
}

TEST(Ackermann, CovarianceIsThatOfTheCentralDifferenceJacobian) {
  RandomStream random(2, "ackermann");
  const AckermannGeometry geometry;
  const AckermannNoise noise{0.3, 0.05};
  for (int i = 0; i < states; ++i) {
    const AckermannSample sample = random_sample(random);
    const auto increment = [&](const Eigen::VectorXd& input) {
      return ackermann_increment(geometry, noise, {input[0], input[1], sample.duration_s}).T_before_after.vector();
    };
    const Eigen::MatrixXd J = helixnav::testing::central_differences(
        increment, Eigen::Vector2d(sample.wheel_speed_mps, sample.steering_rad), testing::pose_difference);
    const Eigen::Matrix3d expected =
        J * Eigen::Vector2d(noise.sigma_speed_mps, noise.sigma_steering_rad).cwiseAbs2().asDiagonal() * J.transpose();
    const Eigen::Matrix3d covariance = ackermann_increment(geometry, noise, sample).covariance;
    EXPECT_LT((covariance - expected).norm(), 1e-7 * (1.0 + expected.norm()));
  }
}

/// One noise source at a time, in a column that the other cannot mask: checks the signs of J as well.
TEST(Ackermann, EachColumnOfTheJacobianEqualsCentralDifferences) {
  RandomStream random(3, "ackermann");
  const AckermannGeometry geometry;
  for (int i = 0; i < states; ++i) {
    const AckermannSample sample = random_sample(random);
    const auto increment = [&](const Eigen::VectorXd& input) {
      return ackermann_increment(geometry, {}, {input[0], input[1], sample.duration_s}).T_before_after.vector();
    };
    const Eigen::MatrixXd J = helixnav::testing::central_differences(
        increment, Eigen::Vector2d(sample.wheel_speed_mps, sample.steering_rad), testing::pose_difference);
    const Eigen::Matrix3d by_speed = ackermann_increment(geometry, {1.0, 0.0}, sample).covariance;
    const Eigen::Matrix3d by_steering = ackermann_increment(geometry, {0.0, 1.0}, sample).covariance;
    EXPECT_LT((by_speed - J.col(0) * J.col(0).transpose()).norm(), 1e-6 * (1.0 + by_speed.norm()));
    EXPECT_LT((by_steering - J.col(1) * J.col(1).transpose()).norm(), 1e-6 * (1.0 + by_steering.norm()));
  }
}

TEST(Ackermann, SeriesAndClosedFormOfTheArcMeet) {
  // The turn per sample passes 1e-3 rad, at which the two forms change over, between these two steering angles.
  const AckermannGeometry geometry{1.0, 0.0};
  const AckermannNoise noise{0.0, 1.0};
  const Odometry below = ackermann_increment(geometry, noise, {1.0, std::atan(0.999999e-3), 1.0});
  const Odometry above = ackermann_increment(geometry, noise, {1.0, std::atan(1.000001e-3), 1.0});
  EXPECT_NEAR(below.T_before_after.x_m, above.T_before_after.x_m, 1e-11);
  EXPECT_NEAR(below.T_before_after.y_m, above.T_before_after.y_m, 1.1e-9);
  EXPECT_LT((below.covariance - above.covariance).norm(), 1e-8);
}

TEST(Ackermann, StandingStillMovesNothingAndSpeedNoiseStillCounts) {
  const Odometry still = ackermann_increment({}, {0.5, 0.1}, {0.0, 0.3, 0.2});
  EXPECT_EQ(still.T_before_after.vector(), Eigen::Vector3d::Zero());
  EXPECT_GT(still.covariance(0, 0), 0.0);
}

TEST(Ackermann, LeftSteeringTurnsLeftAndTheOuterEncoderOverestimates) {
  const AckermannGeometry geometry;  // encoder on the left
  const Odometry left = ackermann_increment(geometry, {}, {2.0, 0.2, 1.0});
  const Odometry right = ackermann_increment(geometry, {}, {2.0, -0.2, 1.0});
  EXPECT_GT(left.T_before_after.heading_rad, 0.0);
  EXPECT_LT(right.T_before_after.heading_rad, 0.0);
  // In a left turn the left wheel runs slower than the middle of the axle, which has thus gone further.
  EXPECT_GT(left.T_before_after.x_m, 2.0 * std::cos(0.1));
  EXPECT_LT(right.T_before_after.position_m().norm(), 2.0);
}

}  // namespace
}  // namespace helixnav::core
