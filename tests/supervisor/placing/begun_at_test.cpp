// SPDX-License-Identifier: BSD-3-Clause
// A session begun at a pose on a map that was given, known relative to the landmarks around it.
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "circuits.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "helixnav/supervisor/pose_on_map.hpp"
#include "placing/place_by_points.hpp"

namespace helixnav::supervisor {
namespace {

core::JointMap mapped() {
  const core::Recording run = sim::simulate(wide_circuit(), 1);
  Navigator navigator(run.start);
  drive(run, navigator, [&](const core::Scan& scan, std::size_t) { navigator.observe(scan); });
  core::JointMap map = joint_map(navigator.filter(), navigator.map());
  map.states.assign(map.joint.ids.size(), core::LandmarkState::mature);
  return map;
}

/// Moved and turned as a whole by an error of metres, as far from the start of a long drive.
core::JointMap adrift(core::JointMap map) {
  const auto landmarks = static_cast<Eigen::Index>(map.joint.ids.size());
  Eigen::MatrixXd common(2 * landmarks, 3);
  for (Eigen::Index i = 0; i < landmarks; ++i) {
    common.middleRows<2>(2 * i) = point_by_place(core::Pose2(), map.joint.points_m[static_cast<std::size_t>(i)]);
  }
  const Eigen::Matrix3d drift = Eigen::Vector3d(100.0, 60.0, 0.01).asDiagonal();
  map.joint.covariance.bottomRightCorner(2 * landmarks, 2 * landmarks) += common * drift * common.transpose();
  return map;
}

core::PoseGaussian some_pose() {
  Eigen::Matrix3d P;
  P << 0.25, 0.05, 0.0, 0.05, 0.2, 0.001, 0.0, 0.001, 0.0027;
  return {core::Pose2(20.0, 3.0, 0.4), P};
}

TEST(PlaceByPoints, FollowsARigidMotionOfThePoints) {
  const std::vector<Eigen::Vector2d> points_m{{3.0, 1.0}, {-2.0, 7.0}, {10.0, -4.0}, {0.0, 5.0}};
  const core::Pose2 T(1.0, 2.0, 0.3);
  const core::Pose2 motion(1e-6, -2e-6, 3e-6);
  Eigen::VectorXd moved(8);
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    moved.segment<2>(2 * static_cast<Eigen::Index>(i)) = core::transform(motion, points_m[i]) - points_m[i];
  }
  const Eigen::Vector3d expected = core::compose(motion, T).vector() - T.vector();
  EXPECT_LT((place_by_points(T, points_m) * moved - expected).norm(), 1e-10);
}

TEST(BegunAt, TheLandmarksStayAsTheyWereAndThePoseSharesTheirErrors) {
  const core::JointMap map = adrift(mapped());
  const core::JointMap begun = begun_at(map, some_pose());
  const Eigen::Index landmarks = map.joint.covariance.rows() - 3;
  EXPECT_EQ(begun.joint.covariance.bottomRightCorner(landmarks, landmarks),
            map.joint.covariance.bottomRightCorner(landmarks, landmarks));
  EXPECT_GT(begun.joint.covariance(0, 0), 50.0) << "in the frame of the map";
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(begun.joint.covariance, Eigen::EigenvaluesOnly);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-9 * eigen.eigenvalues().maxCoeff());
  const core::PoseGaussian on_map = pose_on_map(cekf::CompressedEkf(begun.joint, begun.next_name, {}), begun.next_name);
  EXPECT_EQ(on_map.mean.vector(), some_pose().mean.vector());
  EXPECT_LT((on_map.covariance - some_pose().covariance).norm(), 1e-8);
}

TEST(BegunAt, TentativeLandmarksAreLeftOut) {
  core::JointMap map = mapped();
  ASSERT_GT(map.joint.ids.size(), 6u);
  map.states.assign(map.joint.ids.size(), core::LandmarkState::mature);
  map.states[1] = map.states[4] = core::LandmarkState::tentative;
  const core::JointMap begun = begun_at(map, some_pose());
  ASSERT_EQ(begun.joint.ids.size(), map.joint.ids.size() - 2);
  EXPECT_EQ(begun.joint.ids[1], map.joint.ids[2]);
  EXPECT_EQ(begun.joint.points_m[4], map.joint.points_m[6]);
  EXPECT_EQ(begun.observations[4], map.observations[6]);
  EXPECT_TRUE(begun.has_covariance());
  const Eigen::Matrix2d kept = begun.joint.covariance.block<2, 2>(3 + 2 * 4, 3 + 2 * 1);
  const Eigen::Matrix2d before = map.joint.covariance.block<2, 2>(3 + 2 * 6, 3 + 2 * 2);
  EXPECT_EQ(kept, before);
}

/// Seeing old landmarks says nothing about where the map lies in its frame.
TEST(BegunAt, WhatIsSeenDoesNotMakeTheFrameKnown) {
  const core::Recording today = sim::simulate_in(sim::build_world(wide_circuit().world, 1), wide_circuit(), 71);
  const core::JointMap map = adrift(mapped());
  core::PoseGaussian start = some_pose();
  start.mean = today.true_poses.front().T_world_robot;
  Navigator navigator = Navigator::go_on_in(begun_at(map, start));
  drive(today, navigator, [&](const core::Scan& scan, std::size_t) { navigator.observe(scan); });
  EXPECT_GT(navigator.pose().covariance(0, 0), 50.0);
  EXPECT_LT(pose_on_map(navigator.filter(), map.next_name).covariance(0, 0), 0.1);
}

TEST(BegunAt, WithoutLandmarksAroundThePoseIsKnownInTheFrame) {
  core::JointMap nothing;
  nothing.joint.covariance = Eigen::Matrix3d::Zero();
  const core::JointMap begun = begun_at(nothing, some_pose());
  EXPECT_EQ(begun.joint.covariance, some_pose().covariance);
  EXPECT_FALSE(begun.given.has_value());
}

}  // namespace
}  // namespace helixnav::supervisor
