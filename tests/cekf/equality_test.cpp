// SPDX-License-Identifier: BSD-3-Clause
// The compressed filter is the full filter, to round-off.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "random_program.hpp"
#include "sanitized.hpp"

namespace helixnav::cekf {
namespace {

class Equality : public testing::TestWithParam<Retraction> {};

TEST_P(Equality, HoldsTo1em10InOnePhase) {
  for (const std::uint64_t seed :
       support::sanitized ? std::vector<std::uint64_t>{5} : std::vector<std::uint64_t>{1, 5}) {
    RandomProgram program(seed, {GetParam(), 220, 0, seed == 5});
    for (int k = 0; k < 300; ++k) program.step();
    program.switch_region_randomly();
    program.start_oracle_from_filter();
    const int lazy_before = program.lazy_activations;
    const int removed_before = program.removed;
    // Not 200 steps: along a phase the difference grows to 1e-10 (right-invariant; 125 steps 2e-11). It is the filter's
    // round-off; an oracle in long double differs from it by as much. The weights refer to the anchors themselves, M
    // grows to 5e3 like the inverse of their covariance, E·M·Eᵀ cancels, and an activation carries the rest into the
    // active part. Weights of anchors made independent (Cholesky factor of their covariance) would stay near 1.
    for (int k = 0; k < 125; ++k) {
      program.step();
      if (k % 25 == 12) program.activate_some();
    }
    EXPECT_GE(program.filter.mapped_count(), 100);
    EXPECT_GE(program.lazy_activations, lazy_before + 10);
    EXPECT_GE(program.removed, removed_before + 2);
    const Differences d = compare(program.filter, program.oracle);
    EXPECT_LE(d.covariance, 1e-10) << "seed " << seed;
    EXPECT_LE(d.mean, 1e-10) << "seed " << seed;
  }
}

TEST_P(Equality, HoldsTo1em7OverFiftySwitches) {
  RandomProgram program(3, {GetParam(), 220, 14, false});
  Differences worst;
  for (int k = 0; k < 720; ++k) {
    program.step();
    if (k % 50 != 49) continue;
    const Differences d = compare(program.filter, program.oracle);
    worst.mean = std::max(worst.mean, d.mean);
    worst.covariance = std::max(worst.covariance, d.covariance);
  }
  EXPECT_GE(program.switches, 50);
  EXPECT_GE(program.lazy_activations, 50);
  EXPECT_GE(program.removed, 30);
  EXPECT_GE(program.filter.mapped_count(), 100);
  EXPECT_LE(worst.covariance, 1e-7);
  EXPECT_LE(worst.mean, 1e-7);
}

TEST_P(Equality, PhasesWithAllActiveBetweenOthers) {
  RandomProgram program(7, {GetParam(), 220, 0, false});
  int whole = 0;
  for (int k = 0; k < 320; ++k) {
    if (k % 40 == 20) program.filter.switch_region(program.filter.landmarks());
    const Snapshot before = program.filter.snapshot();
    whole += before.active.weights() == 0 ? 1 : 0;
    program.step();
    if (k % 40 == 35) {  // there and back over a phase with all active
      program.filter.keep_since(program.filter.phase());
      const Snapshot now = program.filter.snapshot();
      program.filter.switch_region(program.filter.landmarks());
      program.filter.restore(now);
    }
    if (k % 40 == 39) program.switch_region_randomly();
  }
  EXPECT_GT(whole, 60);
  const Differences d = compare(program.filter, program.oracle);
  EXPECT_LT(d.mean, 1e-9);
  EXPECT_LT(d.covariance, 1e-9);
}

TEST_P(Equality, HoldsWhenClosedPhasesAreKept) {
  RandomProgram program(4, {GetParam(), 220, 25, false});
  for (int k = 0; k < 350; ++k) {
    program.step();
    if (k == 120) program.filter.keep_since(program.filter.phase());
    if (k == 280) program.filter.keep_since(program.filter.phase() - 2);
  }
  EXPECT_GE(program.filter.phases_kept(), 3);
  const Differences d = compare(program.filter, program.oracle);
  EXPECT_LE(d.covariance, 1e-8);
  EXPECT_LE(d.mean, 1e-8);
}

/// For up to four passive landmarks the weights are read in place; for more they are packed.
TEST_P(Equality, JointOfAFewIsTheBlockOfTheJointOfMany) {
  RandomProgram program(8, {GetParam(), 220, 25, false});
  for (int k = 0; k < 200; ++k) {
    if (k == 140) program.filter.keep_since(program.filter.phase());
    program.step();
  }
  EXPECT_GE(program.filter.phases_kept(), 2);
  std::vector<core::LandmarkId> ids = program.filter.landmarks();
  const auto is_active = [&](core::LandmarkId id) { return program.filter.is_active(id); };
  std::stable_partition(ids.begin(), ids.end(), [&](core::LandmarkId id) { return !is_active(id); });
  ASSERT_FALSE(is_active(ids[9]));
  const core::JointGaussian many = program.filter.joint(ids);
  const double scale = many.covariance.cwiseAbs().maxCoeff();
  for (const std::size_t count : {1U, 2U, 4U, 5U, 9U}) {
    const core::JointGaussian few =
        program.filter.joint({ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(count)});
    const Eigen::Index n = few.covariance.rows();
    EXPECT_LT((few.covariance - many.covariance.topLeftCorner(n, n)).cwiseAbs().maxCoeff(), 1e-12 * scale) << count;
  }
}

/// A point between an active and a passive landmark, moved with the vehicle; ordinary operation follows.
TEST_P(Equality, HoldsForALandmarkDerivedFromPoseAndLandmarks) {
  RandomProgram program(6, {GetParam(), 220, 25, false});
  for (int k = 0; k < 160; ++k) program.step();
  const auto& active = program.filter.active_landmarks();
  ASSERT_GE(active.size(), 2U);
  const std::vector<core::LandmarkId> mapped = program.filter.landmarks();
  const auto passive =
      std::find_if(mapped.begin(), mapped.end(), [&](core::LandmarkId id) { return !program.filter.is_active(id); });
  ASSERT_NE(passive, mapped.end());

  DerivedPoint point;
  point.ids = {active.front(), *passive, active.back()};
  point.G.resize(2, 9);
  point.G << 0.3, -0.1, 2.0, 0.5, 0.1, 0.4, -0.2, 0.1, 0.0,  //
      0.2, 0.4, -1.5, -0.1, 0.5, 0.2, 0.4, 0.0, 0.1;
  point.noise_m2 << 0.04, 0.01, 0.01, 0.02;
  point.point_m = 0.5 * (program.filter.landmark_mean(point.ids[0]) + program.filter.landmark_mean(point.ids[1]));
  const core::LandmarkId id = program.filter.augment(point);
  program.oracle.augment(id, point.point_m, point.ids, point.G, point.noise_m2);
  EXPECT_TRUE(program.filter.is_active(id));
  const Differences at_once = compare(program.filter, program.oracle);
  EXPECT_LE(at_once.covariance, 1e-10);
  EXPECT_LE(at_once.mean, 1e-10);

  for (int k = 0; k < 60; ++k) program.step();  // two switches and more
  const Differences later = compare(program.filter, program.oracle);
  EXPECT_LE(later.covariance, 1e-8);
  EXPECT_LE(later.mean, 1e-8);
}

TEST_P(Equality, HoldsForRowsAboutPoints) {
  RandomProgram program(7, {GetParam(), 220, 14, false});
  for (int k = 0; k < 200; ++k) program.step();
  const std::vector<core::LandmarkId> mapped = program.filter.landmarks();
  const auto passive =
      std::find_if(mapped.begin(), mapped.end(), [&](core::LandmarkId id) { return !program.filter.is_active(id); });
  ASSERT_NE(passive, mapped.end());
  PointRows rows;
  rows.ids = {program.filter.active_landmarks().front(), *passive};
  rows.H.resize(3, 4);
  rows.H << 3.0, -1.0, 0.5, 2.0,  //
      0.2, 4.0, -1.5, -0.1,       //
      0.0, 1.0, 1.0, -2.0;
  rows.nu = Eigen::Vector3d(0.3, -0.2, 0.4);
  const double nis = program.filter.update(rows).nis;
  EXPECT_NEAR(nis, program.oracle.update(rows.ids, rows.H, rows.nu), 1e-8);
  const Differences at_once = compare(program.filter, program.oracle);
  EXPECT_LE(at_once.covariance, 1e-9);
  EXPECT_LE(at_once.mean, 1e-9);
  for (int k = 0; k < 60; ++k) program.step();  // two switches and more
  const Differences later = compare(program.filter, program.oracle);
  EXPECT_LE(later.covariance, 1e-8);
  EXPECT_LE(later.mean, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(BothRetractions, Equality, testing::Values(Retraction::standard, Retraction::right_invariant),
                         [](const auto& tested) {
                           return tested.param == Retraction::standard ? "Standard" : "RightInvariant";
                         });

}  // namespace
}  // namespace helixnav::cekf
