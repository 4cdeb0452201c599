// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include <Eigen/LU>

#include "atlas_access.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/smoothing/marginals.hpp"
#include "phase/world_form.hpp"
#include "read/joint.hpp"
#include "small_drive.hpp"
#include "solve/eliminate.hpp"

namespace helixnav::atlas {
namespace {

int index_of(const smoothing::Problem& problem, core::LandmarkId id) {
  const auto& all = problem.graph.landmarks;
  return static_cast<int>(std::find_if(all.begin(), all.end(), [id](const auto& l) { return l.name == id; }) -
                          all.begin());
}

void expect_joint(const Atlas& atlas, const smoothing::Problem& problem, const std::vector<core::LandmarkId>& ids) {
  std::vector<int> indices;
  for (const core::LandmarkId id : ids) indices.push_back(index_of(problem, id));
  const int last = static_cast<int>(problem.graph.poses.size()) - 1;
  const Eigen::MatrixXd exact = smoothing::joint_covariance(problem, {last}, indices);
  const core::JointGaussian joint = atlas.joint(ids);
  // Each was linearised at its own final estimate; these are some 1e-8 m apart.
  EXPECT_LT((joint.covariance - exact).cwiseAbs().maxCoeff(), 1e-7 * exact.cwiseAbs().maxCoeff());
  const auto& pose = problem.graph.poses.back().T_world_robot;
  EXPECT_LT((joint.pose.vector() - pose.vector()).norm(), 1e-6);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_LT((joint.points_m[i] - problem.graph.landmarks[static_cast<std::size_t>(indices[i])].point_m).norm(), 1e-6);
  }
}

TEST(Poses, OfAllPhasesTogetherAreThoseOfEachToTheBit) {
  const testing::SmallDrive drive = testing::make_small_drive(24);
  const Atlas atlas = testing::driven(drive, Options());
  const std::vector<std::vector<core::Pose2>> all = atlas.poses();
  ASSERT_EQ(static_cast<int>(all.size()), atlas.phase_count());
  for (std::size_t phase = 0; phase < all.size(); ++phase) {
    const std::vector<core::Pose2> own = atlas.poses_of(static_cast<int>(phase));
    ASSERT_EQ(all[phase].size(), own.size());
    for (std::size_t k = 0; k < own.size(); ++k) EXPECT_EQ(all[phase][k].vector(), own[k].vector());
  }
  EXPECT_TRUE(Atlas().poses().empty());
}

TEST(Joint, AlongThePathsEqualsTheDenseInverseOfAllFactors) {
  const testing::SmallDrive drive = testing::make_small_drive(23);
  Atlas atlas = testing::driven(drive, Options());
  State& state = AtlasAccess::working(atlas);
  AtlasAccess::linearise_in_place(state);
  std::vector<Eigen::Index> first{0};
  for (std::size_t v = 0; v < state.variables.size(); ++v) first.push_back(first.back() + state.variables[v].dim);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(first.back(), first.back());
  for (std::size_t k = 0; k < state.phases.size(); ++k) {
    for (const Part& part : state.phases[k]->parts) {
      Values values;
      std::vector<Eigen::Index> rows;
      for (const int v : part.variables) {
        values.push_back(state.value(v));
        for (int i = 0; i < state.variable(v).dim; ++i) rows.push_back(first[State::index(v)] + i);
      }
      const Eigen::MatrixXd A = world_form(*part.gaussian, values).selfadjointView<Eigen::Lower>();
      H(rows, rows) += A.topLeftCorner(A.rows() - 1, A.rows() - 1);
    }
  }
  H.diagonal().segment<3>(first[State::index(gauge_of(state))]).array() += 1e8;
  const Eigen::MatrixXd S = H.inverse();
  const std::vector<int> wanted{0, 3, static_cast<int>(state.variables.size()) - 1, 7, gauge_of(state), 12, 30};
  std::vector<Eigen::Index> rows;
  for (const int v : wanted) {
    for (int i = 0; i < state.variable(v).dim; ++i) rows.push_back(first[State::index(v)] + i);
  }
  const Eigen::MatrixXd exact = S(rows, rows);
  const Eigen::MatrixXd P = covariance_of(state, wanted);
  EXPECT_LT((P - exact).cwiseAbs().maxCoeff(), 1e-8 * exact.cwiseAbs().maxCoeff());
}

TEST(Joint, EqualsTheMarginalsOfTheOptimumInTheMapFrame) {
  testing::SmallDrive drive = testing::make_small_drive(11);
  const Atlas atlas = testing::driven(drive);
  testing::solve(drive.problem);
  expect_joint(atlas, drive.problem, {});
  expect_joint(atlas, drive.problem, {7});
  expect_joint(atlas, drive.problem, {20, 3, 11, 0, 29, 14});
  std::vector<core::LandmarkId> all;
  for (const Place& place : atlas.landmarks()) all.push_back(place.id);
  expect_joint(atlas, drive.problem, all);
  EXPECT_THROW(atlas.joint({1000}), core::PreconditionError);
}

TEST(Joint, HoldsALandmarkAsOftenAsItIsAskedFor) {
  const Atlas atlas = testing::driven(testing::make_small_drive(11));
  const core::JointGaussian once = atlas.joint({3, 20});
  const core::JointGaussian twice = atlas.joint({20, 3, 20});
  ASSERT_EQ(twice.ids, (std::vector<core::LandmarkId>{20, 3, 20}));
  EXPECT_EQ(twice.points_m[2], once.points_m[1]);
  const std::vector<Eigen::Index> rows{0, 1, 2, 5, 6, 3, 4, 5, 6};
  EXPECT_EQ(twice.covariance, Eigen::MatrixXd(once.covariance(rows, rows)));
}

/// Sought for ever before.
TEST(Joint, HoldsALandmarkUnderBothOfItsNames) {
  Atlas atlas = testing::driven(testing::make_small_drive(11));
  atlas.merge({{20, 3}});
  atlas.settle();
  const core::JointGaussian once = atlas.joint({3}), both = atlas.joint({20, 3});
  ASSERT_EQ(both.ids, (std::vector<core::LandmarkId>{20, 3}));
  const std::vector<Eigen::Index> rows{0, 1, 2, 3, 4, 3, 4};
  EXPECT_EQ(both.covariance, Eigen::MatrixXd(once.covariance(rows, rows)));
}

TEST(Joint, OfAnUncertainStartHasItsCovarianceToo) {
  testing::SmallDrive drive = testing::make_small_drive(12);
  core::PoseGaussian start;
  start.mean = core::Pose2(100.0, -50.0, 2.0);
  start.covariance = Eigen::Vector3d(0.04, 0.09, 0.01).asDiagonal();
  Atlas atlas(start, testing::exact());
  for (const auto& log : drive.logs) testing::add_phase(atlas, log);
  for (auto& pose : drive.problem.graph.poses) pose.T_world_robot = core::compose(start.mean, pose.T_world_robot);
  for (auto& landmark : drive.problem.graph.landmarks) landmark.point_m = core::transform(start.mean, landmark.point_m);
  drive.problem.fixed_poses.clear();
  drive.problem.pose_priors.push_back({0, start.mean, start.covariance});
  EXPECT_NEAR(testing::solve(drive.problem), atlas.chi2(), 1e-6);
  expect_joint(atlas, drive.problem, {4, 18, 25});
}

TEST(Joint, OfACertainStartElsewhereIsCarriedThere) {
  testing::SmallDrive drive = testing::make_small_drive(13);
  core::PoseGaussian start;
  start.mean = core::Pose2(-20.0, 30.0, -1.0);
  Atlas atlas(start, testing::exact());
  for (const auto& log : drive.logs) testing::add_phase(atlas, log);
  for (auto& pose : drive.problem.graph.poses) pose.T_world_robot = core::compose(start.mean, pose.T_world_robot);
  for (auto& landmark : drive.problem.graph.landmarks) landmark.point_m = core::transform(start.mean, landmark.point_m);
  testing::solve(drive.problem);
  expect_joint(atlas, drive.problem, {2, 16, 22});
}

TEST(Joint, AfterFixesEqualsTheProblemWithTheSameFixes) {
  testing::SmallDrive drive = testing::make_small_drive(14);
  Atlas atlas({}, testing::exact());
  core::RandomStream random(15);
  for (std::size_t k = 0; k < drive.logs.size(); ++k) {
    testing::add_phase(atlas, drive.logs[k]);
    if (k % 3 != 1) continue;
    core::AbsoluteFix fix;
    fix.antenna_robot_m = Eigen::Vector2d(0.8, -0.4);
    fix.covariance_m2 << 0.04, 0.01, 0.01, 0.09;
    const int pose = drive.pose_of_clone[k + 1];
    fix.position_world_m = core::transform(drive.truth[static_cast<std::size_t>(pose)], fix.antenna_robot_m) +
                           Eigen::Vector2d(random.normal(0.0, 0.2), random.normal(0.0, 0.3));
    atlas.fix(static_cast<int>(k) + 1, fix);
    atlas.settle();
    drive.problem.graph.fix_edges.push_back({pose, fix});
  }
  EXPECT_NEAR(testing::solve(drive.problem), atlas.chi2(), 1e-6);
  expect_joint(atlas, drive.problem, {1, 12, 24, 28});
}

}  // namespace
}  // namespace helixnav::atlas
