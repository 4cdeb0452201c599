// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "random_program.hpp"
#include "same_bytes.hpp"

namespace helixnav::cekf {
namespace {

class Rewind : public testing::TestWithParam<Retraction> {};

/// Continues the program without the oracle.
void go_on(RandomProgram& program, int steps) {
  for (int k = 0; k < steps; ++k) program.step();
}

TEST_P(Rewind, RestoresBitForBitInsideAPhase) {
  RandomProgram program(21, {GetParam(), 220, 0, false});
  go_on(program, 250);
  program.switch_region_randomly();
  go_on(program, 20);
  const Snapshot snapshot = program.filter.snapshot();
  const std::string before = bytes_of(program.filter);
  RandomProgram twin = program;
  go_on(program, 60);
  ASSERT_FALSE(bytes_of(program.filter) == before);
  program.filter.restore(snapshot);
  EXPECT_TRUE(bytes_of(program.filter) == before);
  // And the future is the same.
  twin.filter = program.filter;
  RandomProgram again = twin;
  go_on(twin, 40);
  go_on(again, 40);
  EXPECT_TRUE(bytes_of(twin.filter) == bytes_of(again.filter));
  const Differences d = compare(twin.filter, twin.oracle);
  EXPECT_LE(d.covariance, 1e-8);
}

TEST_P(Rewind, ReachesBackAcrossRegionSwitchesBitForBit) {
  RandomProgram program(22, {GetParam(), 220, 30, false});
  go_on(program, 200);
  program.filter.keep_since(program.filter.phase());
  const Snapshot snapshot = program.filter.snapshot();
  const std::string before = bytes_of(program.filter);
  RandomProgram past = program;
  const int switches_before = program.switches;
  go_on(program, 200);
  ASSERT_GE(program.switches, switches_before + 5);
  program.filter.restore(snapshot);
  EXPECT_TRUE(bytes_of(program.filter) == before);
  past.filter = program.filter;
  go_on(past, 100);
  const Differences d = compare(past.filter, past.oracle);
  EXPECT_LE(d.covariance, 1e-8);
  EXPECT_LE(d.mean, 1e-8);
}

TEST_P(Rewind, IsReadyForPhasesInWhichNothingWasSeen) {
  RandomProgram program(28, {GetParam(), 220, 30, false});
  go_on(program, 200);
  program.filter.keep_since(program.filter.phase());
  for (int k = 0; k < 3; ++k) program.switch_region_randomly();
  ASSERT_GE(program.filter.phases_kept(), 3);
  EXPECT_LE(compare(program.filter, program.oracle).covariance, 1e-8);
  go_on(program, 100);
  const Differences d = compare(program.filter, program.oracle);
  EXPECT_LE(d.covariance, 1e-8);
  EXPECT_LE(d.mean, 1e-8);
}

TEST_P(Rewind, OfALaterSnapshotWorksAfterAnEarlierOneInTheSamePhase) {
  RandomProgram program(23, {GetParam(), 220, 0, false});
  go_on(program, 250);
  program.switch_region_randomly();
  const Snapshot early = program.filter.snapshot();
  go_on(program, 80);
  const Snapshot late = program.filter.snapshot();
  const std::string at_late = bytes_of(program.filter);
  program.filter.restore(early);
  program.filter.restore(late);
  EXPECT_TRUE(bytes_of(program.filter) == at_late);
}

TEST_P(Rewind, OfASnapshotOutOfReachIsRefusedAndChangesNothing) {
  RandomProgram program(24, {GetParam(), 220, 30, false});
  go_on(program, 100);
  const Snapshot snapshot = program.filter.snapshot();
  go_on(program, 60);
  const std::string before = bytes_of(program.filter);
  EXPECT_FALSE(program.filter.can_restore(snapshot));
  EXPECT_THROW(program.filter.restore(snapshot), core::PreconditionError);
  EXPECT_TRUE(bytes_of(program.filter) == before);
}

TEST_P(Rewind, OfAPhaseThatWasUndoneIsRefused) {
  RandomProgram program(25, {GetParam(), 220, 0, false});
  go_on(program, 100);
  const Snapshot early = program.filter.snapshot();
  program.filter.keep_since(early.phase);
  program.filter.switch_region();
  const Snapshot undone = program.filter.snapshot();
  program.filter.restore(early);
  program.filter.switch_region();
  EXPECT_THROW(program.filter.restore(undone), core::PreconditionError);
}

TEST_P(Rewind, NamesNoLandmarkTwiceWhenAskedTo) {
  RandomProgram program(23, {GetParam(), 60, 0, false});
  go_on(program, 40);
  CompressedEkf& filter = program.filter;
  const Snapshot snapshot = filter.snapshot();
  const core::Observation seen = core::make_range_bearing(5.0, 0.3, 0.1, 0.01);
  const core::LandmarkId undone = filter.augment(seen, {});
  const core::LandmarkId next = filter.next_name();
  EXPECT_EQ(next, undone + 1);
  filter.restore(snapshot);
  filter.name_from(next);
  EXPECT_FALSE(filter.contains(undone));
  const core::LandmarkId fresh = filter.augment(seen, {});
  EXPECT_EQ(fresh, next);
  EXPECT_TRUE(filter.contains(fresh));
  filter.switch_region();
  EXPECT_FALSE(filter.contains(undone));
  EXPECT_TRUE(filter.contains(fresh));
  filter.name_from(0);
  EXPECT_EQ(filter.next_name(), fresh + 1);
}

// A name below the skipped ones is available; one in the map, active or passive, is not.
TEST(Naming, TakesTheCallersName) {
  CompressedEkf filter(core::PoseGaussian{});
  const core::Observation ahead = core::make_range_bearing(5.0, 0.1, 0.1, 0.01);
  filter.augment(ahead, core::Pose2(), 7);
  filter.augment(ahead, core::Pose2(), 3);
  EXPECT_EQ(filter.landmarks(), (std::vector<core::LandmarkId>{3, 7}));
  EXPECT_EQ(filter.augment(ahead, core::Pose2()), 8);
  filter.switch_region({7});
  for (const core::LandmarkId taken : {3, 7, 8, -1}) {
    EXPECT_THROW(filter.augment(ahead, core::Pose2(), taken), core::PreconditionError) << taken;
  }
  EXPECT_EQ(filter.mapped_count(), 3);
  filter.activate(3);
  EXPECT_EQ(filter.landmark_mean(3), filter.landmark_mean(7));
  EXPECT_LT(filter.update({{3, ahead, core::Pose2()}}).nis, 1e-20);
}

TEST(Copies, AreNotChangedByOneAnother) {
  RandomProgram program(29, {Retraction::right_invariant, 220, 30, false});
  go_on(program, 200);
  RandomProgram copy = program;
  const std::string before = bytes_of(copy.filter);
  const core::JointGaussian all = copy.filter.joint(copy.filter.landmarks());
  const int switches = program.switches;
  go_on(program, 100);
  ASSERT_GE(program.switches, switches + 2);
  EXPECT_TRUE(bytes_of(copy.filter) == before);
  EXPECT_EQ(copy.filter.joint(copy.filter.landmarks()).covariance, all.covariance);
  go_on(copy, 100);
  EXPECT_LE(compare(program.filter, program.oracle).covariance, 1e-8);
  EXPECT_LE(compare(copy.filter, copy.oracle).covariance, 1e-8);
}

TEST(SnapshotSize, IsAtMostOneMegabyteAtFiftyActiveLandmarks) {
  RandomProgram program(27, {Retraction::right_invariant, 400, 0, false});
  go_on(program, 200);
  std::vector<core::LandmarkId> ids = program.filter.landmarks();
  ASSERT_GE(ids.size(), 50u);
  ids.resize(50);
  program.filter.switch_region(ids);
  ASSERT_EQ(program.filter.active_count(), 50);
  EXPECT_LE(program.filter.snapshot().bytes(), 1000000u);
}

INSTANTIATE_TEST_SUITE_P(BothRetractions, Rewind, testing::Values(Retraction::standard, Retraction::right_invariant),
                         [](const auto& tested) {
                           return tested.param == Retraction::standard ? "Standard" : "RightInvariant";
                         });

}  // namespace
}  // namespace helixnav::cekf
