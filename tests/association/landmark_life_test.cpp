// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/landmark_life.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::association {
namespace {

using core::LandmarkState;

Eigen::Vector2d at(double x_m) { return {x_m, 0.0}; }

TEST(LandmarkLife, MaturesWhenSeenFromSeveralPlaces) {
  LandmarkLife life;
  life.observe(at(0.0), {}, {4}, {});
  EXPECT_EQ(life.state(4), LandmarkState::tentative);
  EXPECT_TRUE(life.observe(at(1.0), {4}, {}, {4}).matured.empty());
  EXPECT_EQ(life.observe(at(2.0), {4}, {}, {4}).matured, std::vector<core::LandmarkId>{4});
  EXPECT_EQ(life.state(4), LandmarkState::mature);
  EXPECT_EQ(life.record(4).hits, 3);
}

// Rain, glare, a truck alongside: for a second none of the expected landmarks is seen. A felled clearing looks the same, and is refuted
// by one miss per drive past.
TEST(LandmarkLife, ScansThatSeeNothingAtAllInARowAreOneMiss) {
  LandmarkLife life;
  const std::vector<core::LandmarkId> trees{1, 2, 3};
  life.observe(at(0.0), {}, trees, {});
  double x_m = 0.0;
  for (int k = 0; k < 5; ++k) life.observe(at(++x_m), trees, {}, trees);
  for (int k = 0; k < 20; ++k) {
    const bool is_blinded = life.note_if_blinded(0, trees.size());
    EXPECT_EQ(is_blinded, k > 0);
    life.observe(at(++x_m), {}, {}, is_blinded ? std::vector<core::LandmarkId>{} : trees);
  }
  for (const core::LandmarkId tree : trees) EXPECT_EQ(life.record(tree).misses, 1);
  EXPECT_FALSE(life.note_if_blinded(1, trees.size())) << "it sees something";
  EXPECT_FALSE(life.note_if_blinded(0, trees.size())) << "the first of the next row";
}

TEST(LandmarkLife, AScanThatMissesFewIsNotBlinded) {
  LandmarkLife life;
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(life.note_if_blinded(0, 2));
}

// A map keeps landmarks that several looks have placed: sightings no estimate used make one likely, but do not place it.
TEST(LandmarkLife, DoesNotMatureBySightingsThatAreLeftUnused) {
  LandmarkLife life;
  life.observe(at(0.0), {}, {4}, {});
  const double hit = life.observe(at(1.0), {4}, {}, {}).matured.empty() ? life.record(4).log_odds : 0.0;
  for (int k = 2; k <= 9; ++k) life.observe(at(k), {}, {}, {4}, {}, {{4, 0.5}});
  EXPECT_NEAR(life.record(4).log_odds, hit + 8 * 0.5, 1e-12);
  EXPECT_EQ(life.record(4).hits, 2);
  EXPECT_EQ(life.record(4).misses, 0);
  EXPECT_EQ(life.state(4), LandmarkState::tentative);
  EXPECT_EQ(life.observe(at(10.0), {4}, {}, {}).matured, std::vector<core::LandmarkId>{4});
}

TEST(LandmarkLife, AnUnusedSightingSaysNoMoreThanAUsedOne) {
  LandmarkLife life;
  life.observe(at(0.0), {}, {4, 5}, {});
  life.observe(at(1.0), {4}, {}, {}, {}, {{4, 9.0}, {5, 9.0}, {5, 9.0}});
  EXPECT_EQ(life.record(5).log_odds, life.record(4).log_odds);
  EXPECT_THROW(life.observe(at(2.0), {4}, {}, {}, {}, {{6, 1.0}}), core::PreconditionError);
  EXPECT_EQ(life.record(4).hits, 2);
}

TEST(LandmarkLife, LearnsNothingWhileStandingStill) {
  LandmarkLife life;
  life.observe(at(0.0), {}, {4}, {});
  for (int k = 0; k < 1000; ++k) life.observe(at(0.0), k % 2 == 0 ? std::vector{4} : std::vector<int>{}, {}, {4});
  EXPECT_EQ(life.record(4).observations, 501);
  EXPECT_EQ(life.record(4).hits, 1);
  EXPECT_EQ(life.record(4).misses, 0);
}

// A detector with false alarms on a vehicle that stands still: it never drives past any of them.
TEST(LandmarkLife, ClutterOfAPauseIsNotGathered) {
  LandmarkLife life;
  life.observe(at(0.0), {}, {0, 1}, {});
  std::size_t most = 0;
  for (int k = 2; k < 2000; ++k) {  // 0 is a tree that is seen in one scan of three
    life.observe(at(0.01 * (k % 2)), k % 3 == 0 ? std::vector{0} : std::vector<int>{}, {k}, {});
    most = std::max(most, life.records().size());
  }
  EXPECT_LT(most, 25u);
  EXPECT_TRUE(life.contains(0));
  EXPECT_FALSE(life.contains(1));
}

// Landmarks seen from two places, or not seen after the vehicle has driven on, are for looks to judge.
TEST(LandmarkLife, APauseElsewhereRefutesNothing) {
  LandmarkLife life;
  life.observe(at(0.0), {}, {4, 5}, {});
  life.observe(at(1.0), {4}, {}, {});
  for (int k = 0; k < 1000; ++k) life.observe(at(1.0), {}, {}, {});
  EXPECT_TRUE(life.contains(4));
  EXPECT_TRUE(life.contains(5));
}

TEST(LandmarkLife, OddsFollowWhatBecameOfThoseBegun) {
  LandmarkLife life;
  life.observe(at(0.0), {}, {0}, {});
  EXPECT_NEAR(life.odds(0), 1.0, 1e-12);
  for (int k = 1; k <= 9; ++k) {  // nine that are never seen again
    life.observe(at(0.0), {}, {k}, {});
    life.drive(31.0);
    life.observe(at(0.0), {0}, {}, {});
  }
  EXPECT_NEAR(life.odds(0), 1.0 / 10.0, 1e-12);
  EXPECT_NEAR(life.born_per_scan(1.0), (10.0 + 10.0) / (19.0 + 10.0), 1e-12);
  life.observe(at(1.0), {0}, {}, {});
  EXPECT_NEAR(life.odds(0), 0.1 * 7.0, 1e-9) << "a hit: 0.7 to 0.1";
}

TEST(LandmarkLife, TentativeOnesDieUnconfirmedAndLeaveNoTrace) {
  LandmarkLife life;
  life.observe(at(0.0), {}, {4, 5}, {});
  LifeChanges changes;
  for (int k = 1; k <= 2; ++k) changes = life.observe(at(k), {5}, {}, {4, 5});
  EXPECT_EQ(changes.died, std::vector<core::LandmarkId>{4});
  EXPECT_FALSE(life.contains(4));
  EXPECT_EQ(life.state(4), LandmarkState::dead);
  EXPECT_EQ(life.records().size(), 1u);
}

TEST(LandmarkLife, TentativeOnesDieWhenTheDriveLeavesThemBehind) {
  LandmarkLife life;
  life.observe(at(0.0), {}, {4}, {});
  life.drive(30.0);
  EXPECT_TRUE(life.observe(at(30.0), {}, {}, {}).died.empty());
  life.drive(1.0);
  EXPECT_EQ(life.observe(at(31.0), {}, {}, {}).died, std::vector<core::LandmarkId>{4});
}

LandmarkLife with_a_mature_landmark(const LifeOptions& options) {
  LandmarkLife life(options);
  life.observe(at(0.0), {}, {4}, {});
  for (int k = 1; k <= 10; ++k) life.observe(at(k), {4}, {}, {4});
  return life;
}

TEST(LandmarkLife, BeingBornIsNoMiss) {
  LandmarkLife life;
  life.observe(at(0.0), {}, {7}, {7});
  EXPECT_EQ(life.record(7).misses, 0);
  EXPECT_EQ(life.record(7).hits, 1);
}

TEST(LandmarkLife, MatureOnesDieOfStrongEvidenceOnly) {
  LandmarkLife life = with_a_mature_landmark({});
  int misses = 0;
  while (life.contains(4)) life.observe(at(11.0 + misses++), {}, {}, {4});
  EXPECT_EQ(misses, 13);  // (8 + 6) / ln(0.9/0.3)
}

TEST(LandmarkLife, OneThatIsSeenFromAfarOnlyDiesWhenDrivenPastOftenUnseen) {
  LandmarkLife life = with_a_mature_landmark({});
  int passes = 0;
  for (; life.contains(4) && passes < 100; ++passes) {
    for (int k = 0; k < 40; ++k) {  // many scans in one drive past are one look
      life.drive(1.0);
      life.pass({4});
      life.observe(at(k), {}, {}, {});
      if (!life.contains(4)) break;
    }
  }
  EXPECT_GE(passes, 8);
  EXPECT_LE(passes, 14);
}

TEST(LandmarkLife, OneThatIsSeenNowAndThenFromAfarLives) {
  LandmarkLife life = with_a_mature_landmark({});
  for (int lap = 0; lap < 1000; ++lap) {
    life.drive(100.0);
    const bool seen = lap % 2 == 0;
    life.pass(seen ? std::vector<core::LandmarkId>{} : std::vector<core::LandmarkId>{4});
    life.observe(at(seen ? lap : 0.0), seen ? std::vector<core::LandmarkId>{4} : std::vector<core::LandmarkId>{}, {},
                 {});
  }
  EXPECT_TRUE(life.contains(4));
}

TEST(LandmarkLife, MatureOnesLiveForEverWhenToldSo) {
  LifeOptions options;
  options.mature_may_die = false;
  LandmarkLife life = with_a_mature_landmark(options);
  for (int k = 0; k < 1000; ++k) life.observe(at(11.0 + k), {}, {}, {4});
  EXPECT_EQ(life.state(4), LandmarkState::mature);
}

TEST(LandmarkLife, KeepsATreeThatIsOftenHiddenAndDropsClutter) {
  // A tree seen in half of its looks against a place with clutter in every tenth look: 200 lives each of 60 looks.
  core::RandomStream random(20, "life");
  int trees_kept = 0;
  int phantoms_matured = 0;
  for (int t = 0; t < 200; ++t) {
    LandmarkLife life;
    life.observe(at(0.0), {}, {0, 1}, {});
    bool phantom_matured = false;
    for (int k = 1; k <= 60; ++k) {
      std::vector<core::LandmarkId> seen;
      std::vector<core::LandmarkId> expected;
      for (const LandmarkRecord& record : life.records()) expected.push_back(record.id);
      if (life.contains(0) && (k <= 3 || random.bernoulli(0.5))) seen.push_back(0);
      if (life.contains(1) && random.bernoulli(0.1)) seen.push_back(1);
      for (const core::LandmarkId id : life.observe(at(k), seen, {}, expected).matured) phantom_matured |= id == 1;
    }
    trees_kept += life.state(0) == LandmarkState::mature;
    phantoms_matured += phantom_matured;
  }
  EXPECT_GE(trees_kept, 195);       // drift per look +0.42 nats against a fall of 16
  EXPECT_LE(phantoms_matured, 12);  // two hits before two net misses: about 0.01 + 0.01, here 2 % expected
}

TEST(LandmarkLife, RefusesUnknownAndRebornLandmarksAndStaysAsItWas) {
  LandmarkLife life;
  life.observe(at(0.0), {}, {1}, {});
  EXPECT_THROW(life.observe(at(1.0), {1, 2}, {}, {}), core::PreconditionError);
  EXPECT_THROW(life.observe(at(1.0), {1}, {}, {2}), core::PreconditionError);
  EXPECT_THROW(life.observe(at(1.0), {1}, {1}, {}), core::PreconditionError);
  EXPECT_THROW(life.observe(at(1.0), {1}, {3, 3}, {}), core::PreconditionError);
  EXPECT_THROW(life.remove(2), core::PreconditionError);
  EXPECT_THROW(life.record(2), core::PreconditionError);
  EXPECT_EQ(life.record(1).observations, 1);
  LifeOptions options;
  options.false_hit_probability = 0.9;
  EXPECT_THROW(LandmarkLife{options}, core::PreconditionError);
  options.false_hit_probability = std::nan("");
  EXPECT_THROW(LandmarkLife{options}, core::PreconditionError);
}

TEST(LandmarkLife, OfTwoThatAreOneGoesOnAsOne) {
  LandmarkLife life;
  life.observe(at(0.0), {}, {4, 5}, {});
  for (double x = 1.0; x <= 3.0; x += 1.0) life.observe(at(x), {4, 5}, {}, {});
  life.drive(100.0);
  life.observe(at(100.0), {}, {9, 10}, {});
  life.drive(1.0);
  life.observe(at(101.0), {9, 10}, {}, {});
  const int observations = life.record(4).observations + life.record(9).observations;
  life.merge(4, 9);
  EXPECT_FALSE(life.contains(9));
  EXPECT_EQ(life.state(4), LandmarkState::mature);
  EXPECT_EQ(life.record(4).observations, observations);
  EXPECT_EQ(life.record(4).hits, 6);
  EXPECT_EQ(life.record(4).last_seen_path_m, 101.0);
  EXPECT_EQ(life.record(4).born_path_m, 0.0);
  EXPECT_THROW(life.merge(4, 4), core::PreconditionError);
  EXPECT_THROW(life.merge(4, 9), core::PreconditionError);
  EXPECT_THROW(life.merge(9, 4), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::association
