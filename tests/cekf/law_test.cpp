// SPDX-License-Identifier: BSD-3-Clause
// What must hold after any operation.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "random_program.hpp"

namespace helixnav::cekf {
namespace {

class Law : public testing::TestWithParam<Retraction> {};

void expect_covariance(const CompressedEkf& filter, const char* after) {
  const Eigen::MatrixXd P = filter.joint(filter.landmarks()).covariance;
  ASSERT_EQ(P, Eigen::MatrixXd(P.transpose())) << after;
  ASSERT_TRUE(core::is_symmetric_positive_semidefinite(P)) << after;
}

TEST_P(Law, TheCovarianceIsSymmetricPositiveSemidefiniteAfterAnyOperation) {
  RandomProgram program(41, {GetParam(), 220, 0, true});
  for (int k = 0; k < 240; ++k) {
    program.step();
    if (k % 20 == 0) expect_covariance(program.filter, "step");
    if (k % 40 == 39) {
      program.switch_region_randomly();
      expect_covariance(program.filter, "switch");
      program.remove_some();
      expect_covariance(program.filter, "remove");
      program.activate_some();
      expect_covariance(program.filter, "activate");
    }
  }
  const core::LandmarkId old = program.filter.active_landmarks().front();
  program.filter.merge(old, program.map_again(old));
  expect_covariance(program.filter, "merge");
  program.filter.global_update();
  expect_covariance(program.filter, "global update");
}

TEST_P(Law, LandmarksWithinAreThoseWhoseMeanIsNear) {
  RandomProgram program(42, {GetParam(), 220, 30, false});
  for (int k = 0; k < 250; ++k) program.step();
  const CompressedEkf& filter = program.filter;
  const Eigen::Vector2d here = filter.pose().mean.position_m();
  for (const double radius_m : {5.0, 30.0, 70.0, 500.0}) {
    std::vector<core::LandmarkId> expected;
    for (const core::LandmarkId id : filter.landmarks()) {
      if ((filter.landmark(id).mean_m - here).norm() <= radius_m) expected.push_back(id);
    }
    EXPECT_EQ(filter.landmarks_within(here, radius_m), expected) << radius_m;
  }
}

TEST_P(Law, TheCheapMeanIsTheMarginalsAndTheSigmaBoundHolds) {
  RandomProgram program(43, {GetParam(), 220, 30, false});
  int passive = 0;
  for (int k = 0; k < 250; ++k) {
    program.step();
    const CompressedEkf& filter = program.filter;
    for (const core::LandmarkId id : filter.landmarks()) {
      const core::PointGaussian marginal = filter.landmark(id);
      EXPECT_EQ(filter.landmark_mean(id), marginal.mean_m) << id;
      EXPECT_GE(filter.landmark_sigma_bound_m(id), std::sqrt(marginal.covariance_m2.trace()) * (1.0 - 1e-12)) << id;
      passive += filter.is_active(id) ? 0 : 1;
    }
  }
  EXPECT_GT(passive, 1000);
}

TEST_P(Law, TheCrossCovarianceIsThatOfTheJoint) {
  RandomProgram program(45, {GetParam(), 220, 30, false});
  int passive = 0;
  int most_phases = 0;
  for (int k = 0; k < 250; ++k) {
    program.step();
    if (k == 120) program.filter.keep_since(program.filter.phase());  // closed phases that are not absorbed
    const CompressedEkf& filter = program.filter;
    const std::vector<core::LandmarkId> ids = filter.landmarks();
    if (k % 5 != 0 || ids.size() < 2) continue;
    std::vector<core::LandmarkId> rows, columns;
    std::vector<Eigen::Index> joint_rows, joint_columns;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
      (i % 3 == 0 ? rows : columns).push_back(ids[i]);
      auto& of = i % 3 == 0 ? joint_rows : joint_columns;
      of.insert(of.end(), {row, row + 1});
    }
    const Eigen::MatrixXd P = filter.joint(ids).covariance;
    const Eigen::MatrixXd C = filter.cross_covariance(rows, columns);
    ASSERT_LE((C - P(joint_rows, joint_columns)).cwiseAbs().maxCoeff(), 1e-12 * P.cwiseAbs().maxCoeff()) << k;
    passive += filter.mapped_count() - filter.active_count();
    most_phases = std::max(most_phases, filter.phases_kept());
  }
  EXPECT_GT(passive, 100);
  EXPECT_GT(most_phases, 2);
}

TEST_P(Law, TheOutlooksAreWhatIsToldOfEachLandmark) {
  RandomProgram program(44, {GetParam(), 220, 30, false});
  for (int k = 0; k < 250; ++k) {
    program.step();
    const CompressedEkf& filter = program.filter;
    const std::vector<core::LandmarkId> ids = filter.landmarks();
    const std::vector<Outlook> outlooks = filter.outlooks(ids);
    ASSERT_EQ(outlooks.size(), ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      EXPECT_LT((outlooks[i].mean_m - filter.landmark_mean(ids[i])).norm(), 1e-9) << ids[i];
      EXPECT_NEAR(outlooks[i].sigma_bound_m, filter.landmark_sigma_bound_m(ids[i]), 1e-9) << ids[i];
      EXPECT_LT((outlooks[i].with_pose - filter.covariance_with_pose(ids[i])).cwiseAbs().maxCoeff(), 1e-9) << ids[i];
    }
  }
}

TEST_P(Law, TheMarginalsOfManyAreThoseOfEach) {
  RandomProgram program(45, {GetParam(), 220, 30, false});
  for (int k = 0; k < 250; ++k) {
    program.step();
    if (k % 10 != 0) continue;
    const CompressedEkf& filter = program.filter;
    std::vector<core::LandmarkId> ids = filter.landmarks();
    std::reverse(ids.begin(), ids.end());
    const std::vector<core::PointGaussian> marginals = filter.marginals(ids);
    ASSERT_EQ(marginals.size(), ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const core::PointGaussian one = filter.landmark(ids[i]);
      EXPECT_LT((marginals[i].mean_m - one.mean_m).norm(), 1e-9) << ids[i];
      EXPECT_LT((marginals[i].covariance_m2 - one.covariance_m2).norm(), 1e-9 * one.covariance_m2.norm()) << ids[i];
    }
  }
}

TEST_P(Law, ARegionHoldsTheNeighbourhoodAndNoMoreThanAllowed) {
  FilterOptions options;
  options.retraction = GetParam();
  options.cell_side_m = 20.0;
  options.hysteresis_m = 5.0;
  options.max_active_landmarks = 10;
  CompressedEkf filter({}, options);
  const Eigen::Matrix2d R = 0.01 * Eigen::Matrix2d::Identity();
  for (int i = 0; i < 40; ++i) filter.augment(core::make_cartesian({1.0 * i, 1.0}, R), {});
  EXPECT_TRUE(filter.switch_region_if_due()) << "crowded";
  EXPECT_EQ(filter.active_count(), 8) << "three quarters, so that the next activation makes no switch due";
  EXPECT_TRUE(filter.is_active(0));
  EXPECT_FALSE(filter.is_active(26));
  core::Odometry odometry;
  odometry.T_before_after = core::Pose2(24.0, 0.0, 0.0);
  filter.predict(odometry);
  EXPECT_FALSE(filter.switch_region_if_due()) << "still within the hysteresis";
  odometry.T_before_after = core::Pose2(2.0, 0.0, 0.0);
  filter.predict(odometry);
  EXPECT_TRUE(filter.switch_region_if_due());
  EXPECT_TRUE(filter.is_active(26));
  EXPECT_EQ(filter.mapped_count(), 40);
}

TEST_P(Law, AllAreActiveAndNoWeightsKeptWhereThatCostsNoMore) {
  FilterOptions options;
  options.retraction = GetParam();
  options.max_active_landmarks = 10;
  CompressedEkf filter({}, options);
  const Eigen::Matrix2d R = 0.01 * Eigen::Matrix2d::Identity();
  for (int i = 0; i < 15; ++i) filter.augment(core::make_cartesian({1.0 * i, 1.0}, R), {});
  filter.switch_region({0, 1, 2});
  EXPECT_GT(filter.snapshot().active.weights(), 0);
  filter.switch_region();
  EXPECT_EQ(filter.active_count(), 15) << "more than 10, but 8 of them with weights would cost as much as 16";
  EXPECT_EQ(filter.snapshot().active.weights(), 0);
  EXPECT_FALSE(filter.switch_region_if_due());
  for (int i = 15; i < 31; ++i) filter.augment(core::make_cartesian({1.0 * i, 1.0}, R), {});
  EXPECT_TRUE(filter.switch_region_if_due()) << "crowded";
  EXPECT_EQ(filter.active_count(), 8);
  EXPECT_GT(filter.snapshot().active.weights(), 0);
}

TEST_P(Law, AllAreActiveWherePhasesThatSeeLittleCostMore) {
  FilterOptions options;
  options.retraction = GetParam();
  options.max_active_landmarks = 10;
  const core::Observation observation = core::make_cartesian({1.0, 1.0}, 0.01 * Eigen::Matrix2d::Identity());
  const auto filter_after_a_phase_of = [&](int updates) {
    CompressedEkf filter({}, options);
    for (int i = 0; i < 60; ++i) filter.augment(core::make_cartesian({1.0 + i / 8, 1.0 + i % 8}, observation.R), {});
    filter.switch_region({0, 1, 2});
    for (int k = 0; k < updates; ++k) filter.update({{0, observation, {}}});
    filter.switch_region();  // its cost is known once it has ended
    EXPECT_EQ(filter.active_count(), 8);
    filter.switch_region();
    return filter;
  };
  CompressedEkf few = filter_after_a_phase_of(1);
  EXPECT_EQ(few.active_count(), 60)
      << "more than 32 or 48, but two rows of 123 columns are less than what a phase ends with";
  EXPECT_EQ(few.snapshot().active.weights(), 0);
  const long phase = few.phase();
  core::Odometry far;
  far.T_before_after = core::Pose2(41.0, 0.0, 0.0);
  few.predict(far);
  EXPECT_TRUE(few.switch_region_if_due()) << "nothing is near, so that little would be active";
  EXPECT_EQ(few.active_count(), 0);
  EXPECT_EQ(few.phase(), phase + 1);
  CompressedEkf many = filter_after_a_phase_of(200);
  EXPECT_EQ(many.active_count(), 8);
  EXPECT_GT(many.snapshot().active.weights(), 0);
}

TEST_P(Law, WhatIsActiveAltogetherStaysSoWithoutASwitch) {
  FilterOptions options;
  options.retraction = GetParam();
  options.max_active_landmarks = 10;
  CompressedEkf filter({}, options);
  const Eigen::Matrix2d R = 0.01 * Eigen::Matrix2d::Identity();
  for (int i = 0; i < 15; ++i) filter.augment(core::make_cartesian({25.0 + 0.5 * i, 1.0}, R), {});
  core::Odometry ahead;
  ahead.T_before_after = core::Pose2(41.0, 0.0, 0.0);
  filter.predict(ahead);
  const Snapshot before = filter.snapshot();
  EXPECT_FALSE(filter.switch_region_if_due()) << "15 are near, and all that there are";
  EXPECT_EQ(filter.phase(), before.phase);
  EXPECT_NE(filter.snapshot().active.cell, before.active.cell);
  filter.restore(before);
  EXPECT_EQ(filter.snapshot().active.cell, before.active.cell) << "where the region was chosen goes with a restore";
}

TEST_P(Law, AScanThatSeesManyMayHaveTwiceAsManyActive) {
  FilterOptions options;
  options.retraction = GetParam();
  options.max_active_landmarks = 10;
  CompressedEkf filter({}, options);
  const Eigen::Matrix2d R = 0.01 * Eigen::Matrix2d::Identity();
  std::vector<Match> seen;
  for (int i = 0; i < 31; ++i) {
    const core::Observation observation = core::make_cartesian({1.0 * i, 1.0}, R);
    const core::LandmarkId id = filter.augment(observation, {});
    if (i < 8) seen.push_back({id, observation, {}});
  }
  const Snapshot before = filter.snapshot();
  filter.update(seen);
  EXPECT_FALSE(filter.switch_region_if_due()) << "31 of 32, or of 48";
  filter.restore(before);
  EXPECT_TRUE(filter.switch_region_if_due()) << "what the last update saw goes with a restore";
}

INSTANTIATE_TEST_SUITE_P(BothRetractions, Law, testing::Values(Retraction::standard, Retraction::right_invariant),
                         [](const auto& tested) {
                           return tested.param == Retraction::standard ? "Standard" : "RightInvariant";
                         });

}  // namespace
}  // namespace helixnav::cekf
