// SPDX-License-Identifier: BSD-3-Clause
// Orchards, where every pitch is a rival: drives that used to be closed wrongly.
#include <gtest/gtest.h>

#include "judged_drive.hpp"

namespace helixnav::supervisor {
namespace {

evaluation::RunScore navigate_orchard(std::uint64_t seed, double odometry_noise) {
  sim::Scenario scenario = sim::named_scenario("orchard");
  scenario.true_noise.odometry.sigma_speed_mps *= odometry_noise;
  scenario.true_noise.odometry.sigma_steering_rad *= odometry_noise;
  scenario.assumed_noise = scenario.true_noise;
  return navigate_and_judge(scenario, seed);
}

TEST(Lattice, IsNotClosedAPitchOffAfterAShortDrift) {
  // The trees of the same row that the vehicle had just passed were taken for old ground: a frame with one base among
  // them made the true place a thousand sigma unlikely, and so not a rival.
  const evaluation::RunScore score = navigate_orchard(1008, 0.5);
  EXPECT_NE(score.verdict, evaluation::RunVerdict::false_closure);
  EXPECT_EQ(score.wrong_old_matches, 0);
}

TEST(Lattice, IsClosedRightlyFromFarOff) {
  const evaluation::RunScore score = navigate_orchard(1016, 1.0);  // 32 m off, and once closed 19 m off
  EXPECT_EQ(score.verdict, evaluation::RunVerdict::closed);
}

TEST(Lattice, BehindADriftOfItsPitchIsNotComparedAsRigid) {
  const evaluation::RunScore score = navigate_orchard(1079, 1.0);
  EXPECT_EQ(score.verdict, evaluation::RunVerdict::closed);
  ASSERT_EQ(score.closures.size(), 1u);
  EXPECT_EQ(score.closures.front().wrong_pairs, 0);
}

TEST(Lattice, ThatWasLeftBehindIsNoMapOfItsOwn) {
  // Closed 60 m past the lattice, when each of its 38 and 50 trees was off by a third of the pitch or more; in the
  // second drive the replay with all pairs costs too much, and they are merged.
  for (const std::uint64_t seed : {1004u, 1148u}) {
    const evaluation::RunScore score = navigate_orchard(seed, 1.0);
    EXPECT_EQ(score.verdict, evaluation::RunVerdict::closed) << seed;
    EXPECT_LE(score.duplicates, 1) << seed;
    ASSERT_EQ(score.closures.size(), 1u) << seed;
    EXPECT_GE(score.closures.front().pairs, 40) << seed;
    EXPECT_EQ(score.closures.front().wrong_pairs, 0) << seed;
  }
}

}  // namespace
}  // namespace helixnav::supervisor
