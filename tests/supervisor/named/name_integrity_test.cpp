// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/name_integrity.hpp"

#include <gtest/gtest.h>

namespace helixnav::supervisor {
namespace {

using Ids = std::vector<core::LandmarkId>;
using Contradicted = std::vector<ContradictedName>;

constexpr NameIntegrity::AboutMotion no_slip{-5.0, false};
constexpr NameIntegrity::AboutMotion slip{5.0, true};
constexpr NameIntegrity::AboutMotion far_away{-5.0, true};

Contradicted contradicted(const Ids& contradicting) {
  Contradicted all;
  for (const core::LandmarkId id : contradicting) all.push_back({id, {}, true});
  return all;
}

Contradicted contradicted_at(core::LandmarkId id, double x_m) {
  return {{id, core::PointGaussian{{x_m, 0.0}, 0.01 * Eigen::Matrix2d::Identity()}, true}};
}

TEST(NameIntegrity, BlamesOneNameAmongMany) {
  NameIntegrity integrity;
  EXPECT_TRUE(integrity.blames_names(contradicted({7}), {1, 2, 3}, no_slip));
  EXPECT_TRUE(integrity.blames_names(contradicted({7}), {1, 2, 3}, no_slip));
}

TEST(NameIntegrity, BlamesTheMotionWhereASlipIsLikelierAndTwoContradict) {
  NameIntegrity integrity;
  EXPECT_FALSE(integrity.blames_names(contradicted({1, 2, 3}), {}, slip));
}

TEST(NameIntegrity, BlamesTheMotionWhereOneContradictsAgain) {
  NameIntegrity integrity;
  EXPECT_TRUE(integrity.blames_names(contradicted({1}), {}, slip));
  EXPECT_FALSE(integrity.blames_names(contradicted({1}), {}, slip));
}

TEST(NameIntegrity, ForgetsAContradictionOnceOthersHaveAgreed) {
  NameIntegrity integrity;
  EXPECT_TRUE(integrity.blames_names(contradicted({1}), {}, slip));
  integrity.agree({2, 3});
  EXPECT_TRUE(integrity.blames_names(contradicted({4}), {}, slip));
}

TEST(NameIntegrity, BlamesTheMotionWhereAllAgreeAboutAPoseFarAway) {
  NameIntegrity integrity;
  EXPECT_TRUE(integrity.blames_names(contradicted({1, 2}), {3, 4, 5}, far_away));
  NameIntegrity outnumbered;
  EXPECT_FALSE(outnumbered.blames_names(contradicted({1, 2, 3}), {4}, far_away));
}

TEST(NameIntegrity, BelievesInAMotionThatFarByNothingLessThanSixLandmarksOneByOne) {
  NameIntegrity integrity;
  for (core::LandmarkId id = 0; id < 5; ++id)
    EXPECT_TRUE(integrity.blames_names(contradicted({id}), {}, far_away)) << id;
  EXPECT_FALSE(integrity.blames_names(contradicted({5}), {}, far_away));
}

TEST(NameIntegrity, FindsALandmarkMisplacedThatIsContradictedFiveTimesInARow) {
  NameIntegrity integrity;
  for (int i = 0; i < 4; ++i) integrity.blames_names(contradicted({7}), {1, 2}, no_slip);
  integrity.agree({7});
  for (int i = 0; i < 4; ++i) integrity.blames_names(contradicted({7}), {1, 2}, no_slip);
  EXPECT_FALSE(integrity.is_misplaced(7));
  integrity.blames_names(contradicted({7}), {1, 2}, no_slip);
  EXPECT_TRUE(integrity.is_misplaced(7));
  integrity.begin_anew(70, 7);
  EXPECT_FALSE(integrity.is_misplaced(7));
  EXPECT_TRUE(integrity.is_superseded(7));
}

/// Out of view, a landmark has no other sightings than those of others under its name.
TEST(NameIntegrity, FindsNoLandmarkMisplacedThatIsSeenHereAndThere) {
  NameIntegrity integrity;
  for (int i = 0; i < 30; ++i) {
    integrity.blames_names(contradicted_at(7, 10.0 * (i % 7)), {1, 2}, no_slip);
    EXPECT_FALSE(integrity.is_misplaced(7)) << i;
  }
  for (int i = 0; i < 7; ++i) integrity.blames_names(contradicted_at(7, 100.0 + 0.05 * (i % 3)), {1, 2}, no_slip);
  EXPECT_TRUE(integrity.is_misplaced(7));
}

TEST(NameIntegrity, CountsNoRangeOrBearingOfWhatIsOutOfView) {
  NameIntegrity integrity;
  for (int i = 0; i < 10; ++i) integrity.blames_names({{7, {}, false}}, {1, 2}, no_slip);
  EXPECT_FALSE(integrity.is_misplaced(7));
}

/// Nine scans of ten degrees of freedom each.
TEST(NameIntegrity, ScalesByTheMedianAndNeverBelowOne) {
  NameIntegrity integrity;
  for (int i = 0; i < 100; ++i) integrity.note_nis(4.0, 10);
  EXPECT_EQ(integrity.noise_scale(), 1.0);
  for (int i = 0; i < 300; ++i) integrity.note_nis(i % 10 == 0 ? 1e6 : 40.0, 10);
  EXPECT_GT(integrity.noise_scale(), 3.3);
  EXPECT_LT(integrity.noise_scale(), 4.9);
}

}  // namespace
}  // namespace helixnav::supervisor
