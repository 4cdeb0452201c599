// SPDX-License-Identifier: BSD-3-Clause
#include "slip/relative_geometry.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::supervisor {
namespace {

using Eigen::Index;

/// Pose and six landmarks, all correlated with one another.
core::JointGaussian correlated(std::uint64_t seed) {
  core::RandomStream random(seed, "relative geometry test");
  core::JointGaussian joint;
  joint.pose = core::Pose2(3.0, -7.0, 2.1);
  for (int i = 0; i < 6; ++i) {
    joint.ids.push_back(10 + i);
    joint.points_m.emplace_back(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0));
  }
  const Index size = 3 + 2 * static_cast<Index>(joint.ids.size());
  Eigen::MatrixXd root(size, size);
  for (Index i = 0; i < size * size; ++i) root.data()[i] = random.normal(0.0, i % size == 2 ? 0.01 : 0.3);
  joint.covariance = root * root.transpose();
  return joint;
}

Eigen::VectorXd relative_points(const Eigen::VectorXd& state) {
  const core::Pose2 T_robot_world = core::inverse(core::Pose2(state[0], state[1], state[2]));
  Eigen::VectorXd points(state.size() - 3);
  for (Index i = 0; i < points.size() / 2; ++i) {
    points.segment<2>(2 * i) = core::transform(T_robot_world, Eigen::Vector2d(state.segment<2>(3 + 2 * i)));
  }
  return points;
}

Eigen::VectorXd state_of(const core::JointGaussian& joint) {
  Eigen::VectorXd state(joint.covariance.rows());
  state.head<3>() = joint.pose.vector();
  for (std::size_t i = 0; i < joint.points_m.size(); ++i) {
    state.segment<2>(3 + 2 * static_cast<Index>(i)) = joint.points_m[i];
  }
  return state;
}

Eigen::MatrixXd jacobian_by_differences(const Eigen::VectorXd& state) {
  constexpr double step = 1e-6;
  Eigen::MatrixXd J(state.size() - 3, state.size());
  for (Index k = 0; k < state.size(); ++k) {
    Eigen::VectorXd ahead = state;
    Eigen::VectorXd behind = state;
    ahead[k] += step;
    behind[k] -= step;
    J.col(k) = (relative_points(ahead) - relative_points(behind)) / (2.0 * step);
  }
  return J;
}

TEST(RelativeGeometry, IsTheJointCovarianceInTheVehiclesFrame) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const core::JointGaussian joint = correlated(seed);
    const RelativeGeometry geometry(joint);
    const Eigen::VectorXd state = state_of(joint);
    const Eigen::MatrixXd J = jacobian_by_differences(state);
    const Eigen::MatrixXd dense = J * joint.covariance * J.transpose();
    EXPECT_LT((geometry.covariance_m2 - dense).cwiseAbs().maxCoeff(), 1e-6 * dense.cwiseAbs().maxCoeff());
    const Eigen::VectorXd points = relative_points(state);
    for (std::size_t i = 0; i < geometry.points_m.size(); ++i) {
      EXPECT_LT((geometry.points_m[i] - points.segment<2>(2 * static_cast<Index>(i))).norm(), 1e-12);
    }
  }
}

TEST(RelativeGeometry, ForgetsWhatVehicleAndLandmarksHaveDriftedTogether) {
  core::JointGaussian joint = correlated(4);
  const Index size = joint.covariance.rows();
  Eigen::MatrixXd drift(size, 3);  // a rigid motion of everything about the origin
  drift.topRows<3>() << 1.0, 0.0, -joint.pose.y_m, 0.0, 1.0, joint.pose.x_m, 0.0, 0.0, 1.0;
  for (std::size_t i = 0; i < joint.points_m.size(); ++i) {
    drift.middleRows<2>(3 + 2 * static_cast<Index>(i)) << 1.0, 0.0, -joint.points_m[i].y(), 0.0, 1.0,
        joint.points_m[i].x();
  }
  const Eigen::MatrixXd own = RelativeGeometry(joint).covariance_m2;
  const Eigen::Vector3d variances(25.0, 25.0, 0.04);
  joint.covariance += drift * variances.asDiagonal() * drift.transpose();
  EXPECT_LT((RelativeGeometry(joint).covariance_m2 - own).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(PairEquations, AreLinearisedAtTheDisplacement) {
  const RelativeGeometry geometry(correlated(5));
  const std::vector<SeenPoint> seen{{0, {4.0, 1.0}, Eigen::Matrix2d::Identity()},
                                    {1, {-3.0, 9.0}, 0.25 * Eigen::Matrix2d::Identity()}};
  const std::vector<PointPair> pairs{{0, 2}, {1, 5}};
  const Eigen::Vector3d at(0.4, -0.3, 0.1);
  const PairEquations e(geometry, seen, pairs, at);
  constexpr double step = 1e-6;
  const auto residual = [&](const Eigen::Vector3d& displacement) -> Eigen::VectorXd {
    const PairEquations here(geometry, seen, pairs, displacement);
    return here.nu - here.A * displacement;
  };
  for (Index k = 0; k < 3; ++k) {
    const Eigen::Vector3d by = step * Eigen::Vector3d::Unit(k);
    const Eigen::VectorXd slope = (residual(at + by) - residual(at - by)) / (2.0 * step);
    EXPECT_LT((e.A.col(k) + slope).cwiseAbs().maxCoeff(), 1e-6) << k;
  }
  const Eigen::Matrix2d turn = core::rotation(-at.z());
  EXPECT_LT((e.S.topRightCorner<2, 2>() - turn * geometry.covariance_of(2, 5) * turn.transpose()).norm(), 1e-12);
}

TEST(SeenPoints, AreTheNearestOnesInTheFrameOfTheVehicle) {
  core::Scan scan;
  scan.T_robot_sensor = core::Pose2(3.0, 0.0, core::pi / 2.0);
  scan.observations = {core::make_range_bearing(20.0, 0.0, 0.1, 0.01), core::make_bearing(0.3, 0.01),
                       core::make_range_bearing(5.0, 0.0, 0.1, 0.01), core::make_range_bearing(9.0, 0.0, 0.1, 0.01)};
  const std::vector<SeenPoint> seen = seen_points(scan, 2);
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].observation, 2);
  EXPECT_EQ(seen[1].observation, 3);
  EXPECT_LT((seen[0].point_m - Eigen::Vector2d(3.0, 5.0)).norm(), 1e-12);
  EXPECT_NEAR(seen[0].covariance_m2(1, 1), 0.01, 1e-12);
  EXPECT_NEAR(seen[0].covariance_m2(0, 0), 0.0025, 1e-12);
}

}  // namespace
}  // namespace helixnav::supervisor
