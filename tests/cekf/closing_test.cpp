// SPDX-License-Identifier: BSD-3-Clause
// What a closing needs: merge, iterated joint update, position fixes; each equal to the full filter.
#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "random_program.hpp"

namespace helixnav::cekf {
namespace {

class Closing : public testing::TestWithParam<Retraction> {};

/// A map with active and passive landmarks.
RandomProgram prepared(Retraction retraction, std::uint64_t seed) {
  RandomProgram program(seed, {retraction, 220, 40, false});
  for (int k = 0; k < 300; ++k) program.step();
  return program;
}

std::vector<core::LandmarkId> some(const CompressedEkf& filter, bool active, std::size_t count) {
  std::vector<core::LandmarkId> ids;
  for (const core::LandmarkId id : filter.landmarks()) {
    if (filter.is_active(id) == active && ids.size() < count) ids.push_back(id);
  }
  return ids;
}

void expect_equal(const RandomProgram& program, double tolerance) {
  const Differences d = compare(program.filter, program.oracle);
  EXPECT_LE(d.covariance, tolerance);
  EXPECT_LE(d.mean, tolerance);
}

/// Turns the vehicle away from its true pose by dead reckoning with a large error.
void lose_the_pose(RandomProgram& program) {
  core::Odometry lost;
  lost.T_before_after = core::Pose2(0.5, 0.2, 0.2);
  lost.covariance = Eigen::Vector3d(1.0, 1.0, 0.04).asDiagonal();
  program.filter.predict(lost);
  program.oracle.predict(lost);
}

TEST_P(Closing, MergingOnePairEqualsTheFullFilter) {
  RandomProgram program = prepared(GetParam(), 11);
  const auto old = some(program.filter, false, 1);
  lose_the_pose(program);
  const core::LandmarkId again = program.map_again(old[0]);
  const UpdateResult result = program.filter.merge(old[0], again);
  const double cost = program.oracle.merge({{old[0], again}}, 0.02);
  EXPECT_NEAR(result.nis, cost, 1e-6 * cost);
  EXPECT_EQ(result.dof, 2);
  EXPECT_FALSE(program.filter.contains(again));
  expect_equal(program, 1e-8);
}

TEST_P(Closing, MergingSeveralPairsAtOnceEqualsTheFullFilter) {
  RandomProgram program = prepared(GetParam(), 12);
  auto old = some(program.filter, false, 3);
  for (const core::LandmarkId id : some(program.filter, true, 3)) old.push_back(id);
  lose_the_pose(program);
  std::vector<CompressedEkf::LandmarkPair> pairs;
  for (const core::LandmarkId id : old) pairs.emplace_back(id, program.map_again(id));
  program.filter.switch_region(some(program.filter, true, 20));
  const CostByPart before = program.filter.merge_cost(pairs);
  const UpdateResult result = program.filter.merge(pairs);
  const double cost = program.oracle.merge(pairs, 0.02);
  EXPECT_NEAR(result.nis, cost, 1e-6 * cost);
  EXPECT_NEAR(before.cost, cost, 1e-6 * cost);
  EXPECT_EQ(result.dof, 12);
  EXPECT_EQ(before.parts.size(), 6u);
  expect_equal(program, 1e-8);
  for (int k = 0; k < 20; ++k) program.step();  // and the drive goes on
  program.filter.global_update();
  expect_equal(program, 1e-8);
}

TEST_P(Closing, AMergedPairIsOneLandmarkAfterwards) {
  RandomProgram program = prepared(GetParam(), 13);
  const auto old = some(program.filter, true, 1);
  const core::PointGaussian before = program.filter.landmark(old[0]);
  const int mapped = program.filter.mapped_count();
  program.filter.merge(old[0], program.map_again(old[0]));
  EXPECT_EQ(program.filter.mapped_count(), mapped);
  EXPECT_LE(program.filter.landmark(old[0]).covariance_m2.trace(), before.covariance_m2.trace());
}

TEST_P(Closing, AMergeOfStrangersHasACostThatRefusesItAndCanBeAskedBeforehand) {
  RandomProgram program = prepared(GetParam(), 16);
  const auto active = some(program.filter, true, 2);
  const Snapshot before = program.filter.snapshot();
  EXPECT_GT(program.filter.merge_cost({{active[0], active[1]}}).cost, 100.0);
  EXPECT_EQ(before.P, program.filter.snapshot().P);
}

TEST_P(Closing, TheIteratedUpdateEqualsTheFullFilterFarFromTheLinearisation) {
  RandomProgram program = prepared(GetParam(), 14);
  core::Odometry lost;  // a stretch of dead reckoning: 0.25 rad of heading error, metres of position
  lost.T_before_after = core::Pose2(20.0, 1.0, 0.6);
  lost.covariance = Eigen::Vector3d(4.0, 4.0, 0.06).asDiagonal();
  program.filter.predict(lost);
  program.oracle.predict(lost);
  std::vector<Match> matches;
  std::vector<support::FullEkf::Sighting> sightings;
  const core::Pose2 T_robot_sensor(1.0, 0.2, 0.0);
  const core::Pose2 elsewhere = core::compose(program.filter.pose().mean, core::Pose2(1.5, -2.0, 0.25));
  for (const bool active : {true, false}) {
    for (const core::LandmarkId id : some(program.filter, active, 4)) {
      const auto p = core::predict_observation(core::ObservationKind::range_bearing, elsewhere, T_robot_sensor,
                                               program.filter.landmark(id).mean_m);
      const core::Observation z = core::make_range_bearing(p.z_hat[0], p.z_hat[1], 0.1, 0.01);
      matches.push_back({id, z, T_robot_sensor});
      sightings.push_back({id, z, T_robot_sensor});
    }
  }
  const CostByPart before = program.filter.iterated_cost(matches);
  const UpdateResult result = program.filter.update_iterated(matches);
  const double cost = program.oracle.update_iterated(sightings);
  EXPECT_NEAR(result.nis, cost, 1e-6 * cost);
  EXPECT_NEAR(before.cost, cost, 1e-6 * cost);
  EXPECT_EQ(result.dof, 16);
  expect_equal(program, 1e-7);
}

TEST_P(Closing, APositionFixEqualsTheFullFilterAndReachesPassiveLandmarks) {
  RandomProgram program = prepared(GetParam(), 15);
  const auto passive = some(program.filter, false, 1);
  const Eigen::Vector2d before = program.filter.landmark(passive[0]).mean_m;
  core::AbsoluteFix fix;
  fix.antenna_robot_m = {0.5, 0.2};
  fix.position_world_m = core::transform(program.filter.pose().mean, fix.antenna_robot_m) + Eigen::Vector2d(0.3, -0.2);
  fix.covariance_m2 << 0.04, 0.01, 0.01, 0.09;
  const UpdateResult foreseen = program.filter.position_innovation(fix);
  const UpdateResult result = program.filter.update_position(fix);
  EXPECT_EQ(foreseen.nis, result.nis);
  EXPECT_NEAR(result.nis, program.oracle.update_position(fix), 1e-7);
  EXPECT_GT((program.filter.landmark(passive[0]).mean_m - before).norm(), 1e-4);
  expect_equal(program, 1e-8);
}

TEST_P(Closing, AReplacedPoseEqualsTheFullFilterAndOwesTheMapNothing) {
  RandomProgram program = prepared(GetParam(), 17);
  core::PoseGaussian elsewhere;
  elsewhere.mean = core::compose(program.filter.pose().mean, core::Pose2(1.0, -2.0, 0.1));
  elsewhere.covariance = Eigen::Vector3d(0.3, 0.2, 0.01).asDiagonal();
  program.filter.replace_pose(elsewhere);
  program.oracle.x.head<3>() = elsewhere.mean.vector();
  program.oracle.P.topRows(3).setZero();
  program.oracle.P.leftCols(3).setZero();
  program.oracle.P.topLeftCorner<3, 3>() = elsewhere.covariance;
  expect_equal(program, 1e-8);
  for (int k = 0; k < 20; ++k) program.step();
  program.filter.switch_region();
  expect_equal(program, 1e-8);
  core::PoseGaussian bad;
  bad.covariance(0, 0) = -1.0;
  EXPECT_THROW(program.filter.replace_pose(bad), core::PreconditionError);
}

INSTANTIATE_TEST_SUITE_P(BothRetractions, Closing, testing::Values(Retraction::standard, Retraction::right_invariant),
                         [](const auto& tested) {
                           return tested.param == Retraction::standard ? "Standard" : "RightInvariant";
                         });

}  // namespace
}  // namespace helixnav::cekf
