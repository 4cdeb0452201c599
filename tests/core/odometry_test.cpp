// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/odometry.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "helixnav/core/gaussian.hpp"
#include "random_states.hpp"

namespace helixnav::core {
namespace {

using testing::pose_distance;
using testing::random_pose;
using testing::states;

Eigen::Matrix3d random_covariance(RandomStream& random) {
  Eigen::Matrix3d A;
  for (double& a : A.reshaped()) a = random.normal(0.0, 0.3);
  return A * A.transpose();
}

Odometry random_odometry(RandomStream& random, Nanoseconds t_ns) {
  Odometry odometry;
  odometry.t_ns = t_ns;
  odometry.T_before_after = random_pose(random, 3.0);
  odometry.covariance = random_covariance(random);
  return odometry;
}

PoseGaussian predict(const PoseGaussian& pose, const Odometry& u) {
  const ComposeJacobians J = compose_jacobians(pose.mean, u.T_before_after);
  return {compose(pose.mean, u.T_before_after),
          J.J_first * pose.covariance * J.J_first.transpose() + J.J_second * u.covariance * J.J_second.transpose()};
}

TEST(Chain, PredictsAsItsTwoPartsDoInTurn) {
  RandomStream random(1, "odometry");
  for (int i = 0; i < states; ++i) {
    const PoseGaussian start{random_pose(random), random_covariance(random)};
    const Odometry first = random_odometry(random, 10), second = random_odometry(random, 20);
    const PoseGaussian in_turn = predict(predict(start, first), second);
    const PoseGaussian at_once = predict(start, chain(first, second));
    EXPECT_LT(pose_distance(in_turn.mean, at_once.mean), 1e-11);
    EXPECT_LT((in_turn.covariance - at_once.covariance).norm(), 1e-12 * (1.0 + in_turn.covariance.norm()));
  }
}

TEST(Chain, IsAssociative) {
  RandomStream random(2, "odometry");
  for (int i = 0; i < states; ++i) {
    const Odometry a = random_odometry(random, 1), b = random_odometry(random, 2), c = random_odometry(random, 3);
    const Odometry left = chain(chain(a, b), c), right = chain(a, chain(b, c));
    EXPECT_LT(pose_distance(left.T_before_after, right.T_before_after), 1e-12);
    EXPECT_LT((left.covariance - right.covariance).norm(), 1e-12 * (1.0 + left.covariance.norm()));
    EXPECT_EQ(left.t_ns, 3);
  }
}

TEST(Chain, HasNoMotionAsItsNeutralElement) {
  RandomStream random(3, "odometry");
  const Odometry a = random_odometry(random, 7);
  for (const Odometry& chained : {chain(no_motion(0), a), chain(a, no_motion(7))}) {
    EXPECT_EQ(chained.t_ns, 7);
    EXPECT_EQ(chained.T_before_after.vector(), a.T_before_after.vector());
    EXPECT_LT((chained.covariance - a.covariance).norm(), 1e-15);
  }
}

}  // namespace
}  // namespace helixnav::core
