// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/supervisor/joint_map.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double own_m = 0.05;

/// Landmarks each known to `own_m` within a frame that is off by `frame_m` and `frame_rad` about the origin.
core::JointMap misplaced_map(double frame_m, double frame_rad) {
  core::RandomStream random(3, "as drawn");
  core::JointMap map;
  constexpr int count = 40;
  Eigen::MatrixXd by_frame = Eigen::MatrixXd::Zero(3 + 2 * count, 3);
  for (int id = 0; id < count; ++id) {
    const Eigen::Vector2d at_m(random.uniform(80.0, 140.0), random.uniform(-30.0, 30.0));
    map.joint.ids.push_back(id);
    map.joint.points_m.push_back(at_m);
    map.states.push_back(id == 7 ? core::LandmarkState::tentative : core::LandmarkState::mature);
    map.observations.push_back(id);
    by_frame.middleRows<2>(3 + 2 * id) << 1.0, 0.0, -at_m.y(), 0.0, 1.0, at_m.x();
  }
  const Eigen::Vector3d frame(frame_m * frame_m, frame_m * frame_m, frame_rad * frame_rad);
  map.joint.covariance = by_frame * frame.asDiagonal() * by_frame.transpose();
  map.joint.covariance.diagonal().tail(2 * count).array() += own_m * own_m;
  map.next_name = count;
  return map;
}

TEST(AsDrawn, LeavesOutWhereTheMapLiesAndKeepsWhatItsLandmarksDifferBy) {
  const core::JointMap drawn = as_drawn(misplaced_map(20.0, 0.1), 30.0, 0.0);
  ASSERT_EQ(drawn.joint.ids.size(), 39u);
  EXPECT_EQ(drawn.joint.ids[7], 8);
  EXPECT_EQ(drawn.observations[7], 8);
  EXPECT_EQ(drawn.next_name, 40);
  for (Eigen::Index row = 3; row < drawn.joint.covariance.rows(); row += 2) {
    const Eigen::Matrix2d own = drawn.joint.covariance.block<2, 2>(row, row);
    const Eigen::Vector2d variances = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(own).eigenvalues();
    EXPECT_GT(variances.minCoeff(), 0.3 * own_m * own_m);
    EXPECT_LT(variances.maxCoeff(), 1.1 * own_m * own_m);
    EXPECT_TRUE(drawn.joint.covariance.block(row, 0, 2, row).isZero(0.0));
  }
  EXPECT_TRUE(drawn.joint.covariance.topLeftCorner(3, 3).isZero(0.0));
}

TEST(AsDrawn, AddsHalfOfWhatTwoDrivesSeeDifferently) {
  const core::JointMap map = misplaced_map(1.0, 0.01);
  const core::JointMap without = as_drawn(map, 30.0, 0.0), with = as_drawn(map, 30.0, 0.2);
  const Eigen::MatrixXd added = with.joint.covariance - without.joint.covariance;
  EXPECT_LT((added.diagonal().tail(added.rows() - 3).array() - 0.02).abs().maxCoeff(), 1e-12);
}

TEST(AsDrawn, RefusesAMapWhosePartsDoNotFit) {
  core::JointMap map = misplaced_map(1.0, 0.01);
  map.states.pop_back();
  EXPECT_THROW(as_drawn(map, 30.0, 0.1), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::supervisor
