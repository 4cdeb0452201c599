// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "atlas_access.hpp"
#include "helixnav/core/errors.hpp"
#include "small_drive.hpp"

namespace helixnav::atlas {
namespace {

std::vector<core::LandmarkId> ids_of(const Atlas& atlas) {
  std::vector<core::LandmarkId> ids;
  for (const Place& place : atlas.landmarks()) ids.push_back(place.id);
  return ids;
}

void expect_same_map(const Atlas& a, const Atlas& b, double tolerance) {
  ASSERT_EQ(ids_of(a), ids_of(b));
  const core::JointGaussian one = a.joint(ids_of(a));
  const core::JointGaussian other = b.joint(ids_of(b));
  EXPECT_LT((one.pose.vector() - other.pose.vector()).norm(), tolerance);
  for (std::size_t i = 0; i < one.ids.size(); ++i) {
    EXPECT_LT((one.points_m[i] - other.points_m[i]).norm(), tolerance) << one.ids[i];
  }
  const double largest_m2 = one.covariance.cwiseAbs().maxCoeff();
  EXPECT_LT((one.covariance - other.covariance).cwiseAbs().maxCoeff(), tolerance * largest_m2);
  EXPECT_NEAR(a.chi2(), b.chi2(), tolerance * a.chi2());
}

/// Without logs, as a map has them that was put away.
void add_without_log(Atlas& atlas, const PhaseLog& log) {
  atlas.add(derive_factor(log, dead_reckon(log)));
  atlas.settle();
}

core::AbsoluteFix fix_at(const core::Pose2& T_world_robot) {
  core::AbsoluteFix fix;
  fix.position_world_m = T_world_robot.position_m() + Eigen::Vector2d(0.2, -0.1);
  fix.covariance_m2 = 0.5 * Eigen::Matrix2d::Identity();
  fix.antenna_robot_m = {0.7, 0.1};
  return fix;
}

TEST(Factors, AMapPutAwayAndTakenUpAgainIsTheSame) {
  const testing::SmallDrive drive = testing::make_small_drive(31);
  const Atlas atlas = testing::driven(drive);
  const Atlas again = Atlas::from_factors(atlas.factors(), testing::exact());
  EXPECT_TRUE(again.is_settled());
  EXPECT_EQ(atlas.places_of(ids_of(atlas)).back().point_m, again.places_of(ids_of(atlas)).back().point_m);
  expect_same_map(atlas, again, 1e-7);
  EXPECT_EQ(atlas.phase_count(), again.phase_count());
  for (int k = 0; k <= atlas.phase_count(); ++k) {
    EXPECT_LT((atlas.clone(k).vector() - again.clone(k).vector()).norm(), 1e-7) << k;
  }
}

TEST(Factors, WhatWasPutAwayUnsolvedIsSolvedWhenItIsTakenUp) {
  const testing::SmallDrive drive = testing::make_small_drive(31);
  Atlas solved({}, testing::exact());
  Atlas unsolved({}, testing::exact());
  for (const auto& log : drive.logs) {
    solved.add(derive_factor(*log, dead_reckon(*log)));
    unsolved.add(derive_factor(*log, dead_reckon(*log)));
  }
  solved.settle();
  const core::MapFactors factors = unsolved.unsolved_factors();
  EXPECT_EQ(unsolved.nodes_redone(), 0);
  EXPECT_FALSE(factors.is_solved);
  EXPECT_TRUE(solved.factors().is_solved);
  const Atlas again = Atlas::from_factors(factors, testing::exact());
  EXPECT_TRUE(again.is_settled());
  expect_same_map(solved, again, 1e-6);
}

TEST(Factors, WhereSolvingDoesNotEndTheyStayWhereTheyWere) {
  const testing::SmallDrive drive = testing::make_small_drive(31);
  Atlas unsolved({}, testing::exact());
  for (const auto& log : drive.logs) unsolved.add(derive_factor(*log, dead_reckon(*log)));
  const core::MapFactors factors = unsolved.unsolved_factors();
  Options options = testing::exact();
  options.max_rounds = 0;
  const Atlas again = Atlas::from_factors(factors, options);
  EXPECT_TRUE(again.is_settled());
  for (const auto& [id, v] : factors.landmarks) {
    const Eigen::Vector3d& value = factors.variables[static_cast<std::size_t>(v)].value;
    EXPECT_LT((again.landmark(id) - value.head<2>()).norm(), 1e-9) << id;
  }
}

TEST(Factors, FixesAnUncertainStartMergedAndForgottenLandmarksAreKept) {
  const testing::SmallDrive drive = testing::make_small_drive(32);
  Eigen::Matrix3d P = Eigen::Vector3d(0.3, 0.3, 0.05).cwiseAbs2().asDiagonal();
  P(0, 1) = P(1, 0) = 0.02;
  Atlas atlas(core::PoseGaussian{core::Pose2(0.0, 0.0, 0.01), P}, testing::exact());
  for (std::size_t k = 0; k < drive.logs.size(); ++k) {
    testing::add_phase(atlas, drive.logs[k]);
    const auto clone = static_cast<int>(k) + 1;
    const auto pose = static_cast<std::size_t>(drive.pose_of_clone[k + 1]);
    if (k % 3 == 1) atlas.fix(clone, fix_at(drive.truth[pose]));
  }
  atlas.settle();
  const std::vector<core::LandmarkId> ids = ids_of(atlas);
  atlas.merge({{ids[1], ids[0]}});  // a wrong one will do
  atlas.forget(ids[2]);
  atlas.settle();
  const Atlas again = Atlas::from_factors(atlas.factors(), testing::exact());
  expect_same_map(atlas, again, 1e-6);
  EXPECT_FALSE(again.knows(ids[1]));
  EXPECT_FALSE(again.knows(ids[2]));
}

TEST(Factors, GroundDrivenManyTimesIsKeptAsItWasCondensed) {
  testing::SmallDriveOptions many;
  many.steps = 480;
  many.rounds = 10.0;
  const testing::SmallDrive drive = testing::make_small_drive(33, many);
  Options options = testing::exact();
  options.laps_kept = 1;
  Atlas atlas({}, options);
  for (const auto& log : drive.logs) {
    testing::add_phase(atlas, log);
    atlas.condense();
    atlas.settle();
  }
  ASSERT_GT(atlas.size().condensed, 5);
  const Atlas again = Atlas::from_factors(atlas.factors(), options);
  EXPECT_EQ(again.size().condensed, atlas.size().condensed);
  expect_same_map(atlas, again, 1e-6);
}

/// What comes after does not care whether the map was put away in between.
TEST(Factors, TheDriveGoesOn) {
  const testing::SmallDrive drive = testing::make_small_drive(34);
  const std::size_t half = drive.logs.size() / 2;
  Atlas atlas({}, testing::exact());
  for (std::size_t k = 0; k < half; ++k) add_without_log(atlas, *drive.logs[k]);
  Atlas again = Atlas::from_factors(atlas.factors(), testing::exact());
  for (std::size_t k = half; k < drive.logs.size(); ++k) {
    testing::add_phase(atlas, drive.logs[k]);
    testing::add_phase(again, drive.logs[k]);
  }
  expect_same_map(atlas, again, 1e-6);
}

constexpr core::LandmarkId renamed = 1000;

std::shared_ptr<PhaseLog> with_other_names(const PhaseLog& log) {
  auto other = std::make_shared<PhaseLog>(log);
  for (SeenLandmark& seen : other->seen_at_entry) seen.id += renamed;
  for (LoggedStep& step : other->steps) {
    for (SeenLandmark& seen : step.seen) seen.id += renamed;
  }
  return other;
}

/// The first half of a drive, the second half as a drive of its own, and where that began on the first, known to some 2 m
/// and 0.1 rad.
struct TwoDrives {
  testing::SmallDrive drive;
  std::size_t half;
  Atlas first{{}, testing::exact()};
  Atlas second{{}, testing::exact()};
  RelativeGaussian gap;

  explicit TwoDrives(std::uint64_t seed) : drive(testing::make_small_drive(seed)), half(drive.logs.size() / 2) {
    for (std::size_t k = 0; k < half; ++k) testing::add_phase(first, drive.logs[k]);
    for (std::size_t k = half; k < drive.logs.size(); ++k) testing::add_phase(second, with_other_names(*drive.logs[k]));
    gap.information = Eigen::Vector3d(0.25, 0.25, 100.0).asDiagonal();
    gap.vector = Eigen::Vector3d::Zero();
    gap.mean = Eigen::Vector3d(0.4, -0.3, 0.05);
  }

  std::vector<MergePair> pairs() const {
    std::vector<MergePair> pairs;
    for (const core::LandmarkId id : ids_of(second)) {
      if (first.knows(id - renamed)) pairs.emplace_back(id, id - renamed);
    }
    return pairs;
  }
};

/// The exact twin: the same phases added one by one, a phase without landmarks in between.
Atlas one_after_the_other(const TwoDrives& two) {
  Atlas atlas = two.first;
  PhaseFactor gap;
  gap.gaussian = two.gap;
  gap.shape.T_entry_robot.emplace_back(Eigen::Vector3d(two.gap.mean));
  atlas.add(gap);
  atlas.settle();
  for (std::size_t k = two.half; k < two.drive.logs.size(); ++k) {
    testing::add_phase(atlas, with_other_names(*two.drive.logs[k]));
  }
  atlas.merge(two.pairs());
  atlas.settle();
  return atlas;
}

TEST(Factors, TwoDrivesMergedAreOneDriveWithAGap) {
  const TwoDrives two(35);
  ASSERT_GT(two.pairs().size(), 5u);
  Atlas both = two.first.followed_by(two.gap, two.second);
  EXPECT_TRUE(both.is_settled());
  both.merge(two.pairs());
  both.settle();
  expect_same_map(one_after_the_other(two), both, 1e-6);
  EXPECT_EQ(both.phase_count(), two.first.phase_count() + 1 + two.second.phase_count());
}

TEST(Factors, ADriveBehindAnotherLosesItsOwnFrame) {
  TwoDrives two(36);
  const RelativeGaussian gap = two.gap;
  Atlas fixed = two.second;
  const core::Pose2 T_own_clone = fixed.clone(2);
  fixed.fix(2, fix_at(core::Pose2(T_own_clone.x_m + 1.0, T_own_clone.y_m, 0.0)));  // bends it, in a frame of its own
  fixed.settle();
  Atlas both = two.first.followed_by(gap, fixed);
  both.merge(two.pairs());
  both.settle();
  expect_same_map(one_after_the_other(two), both, 1e-6);
}

TEST(Factors, BothDrivesStayAsTheyWere) {
  const TwoDrives two(37);
  const Atlas first = two.first;
  Atlas both = two.first.followed_by(two.gap, two.second);
  both.merge(two.pairs());
  both.settle();
  EXPECT_TRUE(testing::same_bytes(AtlasAccess::settled(first), AtlasAccess::settled(two.first)));
  EXPECT_TRUE(two.second.is_settled());
}

TEST(Factors, WhatDoesNotFitTogetherIsRefused) {
  const Atlas atlas = testing::driven(testing::make_small_drive(38));
  const core::MapFactors right = atlas.factors();
  const auto is_refused = [](const core::MapFactors& map) {
    EXPECT_THROW(Atlas::from_factors(map), core::PreconditionError);
  };
  is_refused({});
  core::MapFactors map = right;
  map.phases.front().parts.front().variables[2] = static_cast<int>(map.variables.size());
  is_refused(map);
  map = right;
  map.phases[1].parts.front().variables[1] = map.poses.front();
  is_refused(map);
  map = right;
  map.poses.pop_back();
  is_refused(map);
  map = right;
  map.landmarks.front().second = map.world;
  is_refused(map);
  map = right;
  map.phases[2].parts.front().gaussian = nullptr;
  is_refused(map);
  map = right;
  map.phases[2] = {};
  map.phases[2].host = 2;
  is_refused(map);
  map = right;
  map.variables[3].value.x() = std::nan("");
  is_refused(map);
  EXPECT_THROW(Atlas().factors(), core::PreconditionError);
}

TEST(Factors, DrivesThatShareANameOrAreNotSettledAreRefused) {
  const TwoDrives two(39);
  EXPECT_THROW(two.first.followed_by(two.gap, two.first), core::PreconditionError);
  RelativeGaussian flat = two.gap;
  flat.information = Eigen::Matrix3d(Eigen::Vector3d(0.25, 0.25, 0.0).asDiagonal());
  EXPECT_THROW(two.first.followed_by(flat, two.second), core::PreconditionError);
  Atlas both = two.first.followed_by(two.gap, two.second);
  both.merge(two.pairs());
  EXPECT_THROW(both.followed_by(two.gap, two.second), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::atlas
