// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "atlas_access.hpp"
#include "small_drive.hpp"
#include "solve/eliminate.hpp"

namespace helixnav::atlas {
namespace {

TEST(Settle, StoppedAfterEveryNodeLeavesAConsistentMapAndEndsInTheSameBits) {
  const testing::SmallDrive drive = testing::make_small_drive(6);
  Atlas atlas = testing::driven(drive, Options());
  PhaseLog log = *drive.logs[1];
  PhaseFactor factor = derive_factor(log, dead_reckon(log));
  factor.gaussian.mean[3] += 3.0;  // far from what the map says: several rounds
  Atlas once = atlas;
  Atlas stopped = atlas;
  once.add(factor);
  stopped.add(factor);
  ASSERT_TRUE(once.settle());
  const core::JointGaussian before = atlas.joint({0, 1, 2});
  int stops = 0;
  while (!stopped.settle([] { return true; })) {
    ++stops;
    const core::JointGaussian still = stopped.joint({0, 1, 2});
    ASSERT_TRUE(testing::same_bytes(still.covariance, before.covariance));
    ASSERT_EQ(stopped.phase_count(), atlas.phase_count());
    if (stops % 7 == 3) stopped = Atlas(stopped);  // a snapshot taken while settling continues, too
  }
  EXPECT_GT(stops, 20);
  EXPECT_TRUE(testing::same_bytes(AtlasAccess::settled(once), AtlasAccess::settled(stopped)));
}

TEST(Settle, StoppedAtAnyNodeAndThenChangedStillEndsAtTheOptimum) {
  const testing::SmallDrive drive = testing::make_small_drive(6);
  Atlas begun({}, testing::exact());
  for (std::size_t k = 0; k < 5; ++k) testing::add_phase(begun, drive.logs[k]);
  const double chi2_before = begun.chi2();
  const auto add = [&drive](Atlas& atlas, std::size_t k) {
    atlas.add(derive_factor(*drive.logs[k], dead_reckon(*drive.logs[k])), drive.logs[k]);
  };
  add(begun, 5);
  Atlas at_once = begun;
  add(at_once, 6);
  ASSERT_TRUE(at_once.settle());
  bool is_whole = false;
  int nodes = 0;
  for (; !is_whole && nodes < 1000; ++nodes) {
    Atlas atlas = begun;
    int left = nodes;
    is_whole = atlas.settle([&left] { return --left < 0; });
    if (!is_whole) {
      ASSERT_EQ(atlas.chi2(), chi2_before) << nodes;
    }
    add(atlas, 6);
    ASSERT_TRUE(atlas.settle()) << nodes;
    ASSERT_NEAR(atlas.chi2(), at_once.chi2(), 1e-6) << nodes;
    ASSERT_LT((atlas.pose().vector() - at_once.pose().vector()).norm(), 1e-6) << nodes;
  }
  EXPECT_TRUE(is_whole);
  EXPECT_GT(nodes, 20);
}

TEST(Settle, OfANewPhaseEqualsAFullPassBitForBit) {
  const testing::SmallDrive drive = testing::make_small_drive(7);
  Atlas atlas = testing::driven(drive, Options());
  State& state = AtlasAccess::working(atlas);
  AtlasAccess::linearise_in_place(state);
  const int before = static_cast<int>(state.nodes.size());
  PhaseLog log = *drive.logs[4];
  atlas.add(derive_factor(log, dead_reckon(log)), nullptr);
  int redone = 0;
  redo_dirty(state, redone, {});
  EXPECT_LT(redone, before);  // a path
  State full = state;
  for (std::size_t i = 0; i < full.nodes.size(); ++i) full.nodes.write(i).dirty = true;
  int all = 0;
  redo_dirty(full, all, {});
  EXPECT_EQ(all, before + 2);
  EXPECT_TRUE(testing::same_bytes(state, full));
}

TEST(Settle, AssigningACopyRollsBackBitForBit) {
  const testing::SmallDrive drive = testing::make_small_drive(8);
  Atlas atlas({}, Options());
  for (std::size_t k = 0; k < 6; ++k) testing::add_phase(atlas, drive.logs[k]);
  const Atlas snapshot = atlas;
  const Atlas twin = testing::driven({std::vector(drive.logs.begin(), drive.logs.begin() + 6), {}, {}, {}}, Options());
  ASSERT_TRUE(testing::same_bytes(AtlasAccess::settled(snapshot), AtlasAccess::settled(twin)));
  for (std::size_t k = 6; k < drive.logs.size(); ++k) testing::add_phase(atlas, drive.logs[k]);
  const Atlas whole = atlas;
  EXPECT_TRUE(testing::same_bytes(AtlasAccess::settled(snapshot), AtlasAccess::settled(twin)));
  atlas = snapshot;
  EXPECT_TRUE(testing::same_bytes(AtlasAccess::settled(atlas), AtlasAccess::settled(twin)));
  EXPECT_EQ(atlas.phase_count(), 6);
  for (std::size_t k = 6; k < drive.logs.size(); ++k) testing::add_phase(atlas, drive.logs[k]);
  EXPECT_TRUE(testing::same_bytes(AtlasAccess::settled(atlas), AtlasAccess::settled(whole)));
}

TEST(Settle, AfterANewLayoutGivesTheSameMap) {
  const testing::SmallDrive drive = testing::make_small_drive(9);
  const Atlas atlas = testing::driven(drive);
  Atlas laid_out = atlas;
  laid_out.reshape();
  laid_out.settle();
  EXPECT_NEAR(atlas.chi2(), laid_out.chi2(), 1e-7);
  const auto places = atlas.landmarks();
  for (const Place& place : places) EXPECT_LT((laid_out.landmark(place.id) - place.point_m).norm(), 1e-7);
  EXPECT_LT((atlas.joint({3, 9}).covariance - laid_out.joint({3, 9}).covariance).norm(), 1e-8);
}

TEST(Settle, LinearisedAsDefaultsSayStaysCloseToTheOptimum) {
  testing::SmallDrive drive = testing::make_small_drive(10);
  const Atlas atlas = testing::driven(drive, Options());
  testing::solve(drive.problem);
  for (const auto& landmark : drive.problem.graph.landmarks) {
    EXPECT_LT((atlas.landmark(static_cast<core::LandmarkId>(landmark.name)) - landmark.point_m).norm(), 0.02);
  }
}

}  // namespace
}  // namespace helixnav::atlas
