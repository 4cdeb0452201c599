// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "atlas_access.hpp"
#include "campaign.hpp"
#include "helixnav/core/errors.hpp"
#include "long_road.hpp"
#include "solve/damped.hpp"

namespace helixnav::atlas {
namespace {

using testing::LongRoad;

double last_heading_rad(Atlas& atlas) {
  const State& state = AtlasAccess::working(atlas);
  return state.value(state.variable_of_clone.back()).z();
}

/// The ordinary way finds it: a phase that sees the end of the drive and its start, a hundred metres beside it, stays where the
/// drive puts it and is not turned by the best fit to both.
TEST(TornClosing, APhaseThatSeesBothEndsIsNotTurned) {
  for (const std::uint64_t seed : {2u, 4u}) {
    LongRoad road(seed);
    Atlas atlas;
    while (road.steps() < LongRoad::steps_a_lap - 60) road.add_phase(atlas);
    atlas.settle();
    const double heading_rad = last_heading_rad(atlas);
    for (int phase = 0; phase < 12; ++phase) {
      road.add_phase(atlas);
      const double turned_rad = core::wrap_to_pi(last_heading_rad(atlas) - heading_rad);
      EXPECT_LT(std::abs(turned_rad), 0.3) << "seed " << seed << ", phase " << phase;
    }
  }
}

TEST(DampedCampaign, ManyPhasesOnOldGroundAtOnceAreSolvedAfterAnyDrift) {
  for (const std::uint64_t seed : support::campaign_seeds(2, 3)) {
    LongRoad road(seed);
    Atlas atlas;
    int waiting = 0;
    while (road.steps() < LongRoad::steps_a_lap - 60) {
      road.add_phase(atlas);
      if (++waiting % 26 == 0) atlas.settle();
    }
    atlas.settle();
    EXPECT_GT(road.error_m(atlas), 20.0) << seed;
    for (int phase = 0; phase < 26; ++phase) road.add_phase(atlas);
    ASSERT_NO_THROW(atlas.settle()) << seed;
    EXPECT_TRUE(atlas.is_settled());
    EXPECT_LT(road.error_m(atlas), 2.0) << seed;
    EXPECT_NEAR(atlas.chi2(), road.dof(), 4.5 * std::sqrt(2.0 * road.dof())) << seed;  // exceeded with probability 1e-5
  }
}

/// Shortened steps alone end where the ordinary passes do.
TEST(DampedCampaign, ShortenedStepsFindTheSameSolution) {
  for (const std::uint64_t seed : support::campaign_seeds(2, 3)) {
    Options options;
    options.rederive_m = options.rederive_rad = 1e9;  // shortened steps do not derive phases again
    LongRoad road(seed);
    Atlas atlas(core::PoseGaussian{}, options);
    int waiting = 0;
    while (road.steps() < LongRoad::steps_a_lap + 60) {
      if (++waiting % 26 == 0) atlas.settle();
      road.add_phase(atlas);
    }
    State state = AtlasAccess::working(atlas);
    int redone = 0;
    damp(state, redone);
    settle_damped(state, redone);
    EXPECT_TRUE(state.is_clean());
    atlas.settle();
    options.bend_m = 1e-6;
    AtlasAccess::settle_with(atlas, options);
    const std::vector<core::Pose2> ordinary = atlas.clones();
    ASSERT_EQ(ordinary.size(), state.variable_of_clone.size());
    const auto pose_of = [&](std::size_t k) { return core::Pose2(state.value(state.variable_of_clone[k])); };
    double off_m = 0.0;
    for (std::size_t k = 0; k < ordinary.size(); ++k) {
      const core::Pose2 damped = core::between(pose_of(0), pose_of(k));  // the values are in a frame of their own
      const core::Pose2 expected = core::between(ordinary[0], ordinary[k]);
      off_m = std::max(off_m, (damped.position_m() - expected.position_m()).norm());
    }
    EXPECT_LT(off_m, 0.02) << seed;
  }
}

TEST(Damped, SeesWhatAFixThatCameWhereTheMapIsFarOffPulls) {
  LongRoad road(1);
  core::PoseGaussian start;
  start.covariance = Eigen::Vector3d(0.01, 0.01, 0.2).cwiseAbs2().asDiagonal();
  Atlas atlas(start);
  int clone = 0;
  while (road.steps() < 500) clone = road.add_phase(atlas);
  atlas.settle();
  const core::Pose2 T_true_turned(0.0, 0.0, 0.1);  // the drive of a kilometre began with this heading error
  road.fix(atlas, clone, T_true_turned);
  State state = AtlasAccess::working(atlas);
  int redone = 0;
  ASSERT_NO_THROW(damp(state, redone)) << "what it was added with is not what it can have at least";
  atlas.settle();
  EXPECT_LT((atlas.pose().position_m() - core::transform(T_true_turned, road.position_m())).norm(), 5.0);
}

}  // namespace
}  // namespace helixnav::atlas
