// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/constellation.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"
#include "lattice_world.hpp"

namespace helixnav::pf_relocalize {
namespace {

using test::Lattice;

/// Size of a maximum matching by exhaustive search.
int largest_matching(const std::vector<std::vector<int>>& partners, std::size_t from, std::set<int>& used) {
  if (from == partners.size()) return 0;
  int best = largest_matching(partners, from + 1, used);
  for (const int j : partners[from]) {
    if (!used.insert(j).second) continue;
    best = std::max(best, 1 + largest_matching(partners, from + 1, used));
    used.erase(j);
  }
  return best;
}

Constellation random_constellation(core::RandomStream& random) {
  Constellation c;
  for (int i = 0; i < 7; ++i) {
    c.branch.push_back({i, {random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0)}, static_cast<int>(random.below(6))});
  }
  for (int j = 0; j < 8; ++j) {
    const double sigma = random.uniform(0.05, 0.3);
    c.old_landmarks.push_back(
        {100 + j,
         {{10.0 + random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0)}, sigma * sigma * Eigen::Matrix2d::Identity()}});
  }
  c.old_drive.T_frame_sensor = {{8.0, 0.0, 0.0}, {10.0, 1.0, 0.5}};
  c.old_drive.field_of_view = {0.0, 5.0, -core::pi / 2, core::pi / 2};
  c.new_drive.T_frame_sensor = {{-2.0, 0.0, 0.0}, {0.0, 0.0, 0.3}};
  c.new_drive.field_of_view = {0.0, 5.0, -core::pi / 2, core::pi / 2};
  c.new_drive.least_views = 2;
  return c;
}

TEST(Constellation, CountsTheLargestMatchingAndContradictionsAsBruteForceDoes) {
  core::RandomStream random(1, "constellation");
  for (int run = 0; run < 300; ++run) {
    const Constellation c = random_constellation(random);
    const core::Pose2 pose(10.0 + random.normal(0.0, 0.3), random.normal(0.0, 0.3), random.normal(0.0, 0.1));
    const ConstellationScore score = score_constellation(c, pose);
    std::vector<std::vector<int>> partners;
    int on_old_ground = 0;
    for (const BranchLandmark& b : c.branch) {
      if (b.hits < 3) continue;
      const Eigen::Vector2d p = core::transform(pose, b.point_robot_m);
      partners.emplace_back();
      on_old_ground += c.old_drive.covers(p) ? 1 : 0;
      for (const OldLandmark& old : c.old_landmarks) {
        const double tolerance = std::min(
            1.5, 3.0 * std::sqrt(old.point.covariance_m2(0, 0) + 0.15 * 0.15) + 0.012 * b.point_robot_m.norm());
        if ((p - old.point.mean_m).norm() < tolerance) partners.back().push_back(old.id);
      }
    }
    std::set<int> used;
    EXPECT_EQ(score.matched, largest_matching(partners, 0, used));
    std::set<int> branch_used, old_used;
    for (const ConstellationPair& pair : score.pairs) {
      EXPECT_TRUE(branch_used.insert(pair.branch).second);
      EXPECT_TRUE(old_used.insert(pair.old_landmark).second);
      EXPECT_LT(pair.distance_m, 1.5);
    }
    EXPECT_EQ(static_cast<int>(score.pairs.size()), score.matched);
    EXPECT_LE(score.unmatched_branch, on_old_ground);
    int unmatched_old = 0;
    for (const OldLandmark& old : c.old_landmarks) {
      if (old_used.count(old.id) == 0 && c.new_drive.covers(core::transform(core::inverse(pose), old.point.mean_m))) {
        ++unmatched_old;
      }
    }
    EXPECT_EQ(score.unmatched_old, unmatched_old);
    const double expected =
        score.matched == 0 ? 0.0 : score.matched / (score.matched + 0.5 * (score.unmatched_branch + unmatched_old));
    EXPECT_DOUBLE_EQ(score.ratio, expected);
  }
}

TEST(Constellation, CoverageShrinksTheViewAndCountsViews) {
  Coverage coverage;
  coverage.T_frame_sensor = {{0.0, 0.0, 0.0}, {1.0, 0.0, core::pi}};
  coverage.field_of_view = {0.5, 20.0, -core::pi / 2, core::pi / 2};
  EXPECT_TRUE(coverage.covers({16.9, 0.0}));
  EXPECT_FALSE(coverage.covers({17.1, 0.0}));
  EXPECT_TRUE(coverage.covers({-3.0, 0.0}));    // seen from the second pose, behind the first
  EXPECT_FALSE(coverage.covers({0.05, 10.0}));  // within the bearing margin of both
  EXPECT_FALSE(coverage.covers({0.2, 0.0}) && coverage.least_views > 1);
  coverage.least_views = 2;
  EXPECT_FALSE(coverage.covers({16.9, 0.0}));
  coverage.field_of_view.min_bearing_rad = -core::pi;
  coverage.field_of_view.max_bearing_rad = core::pi;
  EXPECT_TRUE(coverage.covers({10.0, 10.0}));  // all around: no margin at the back
}

TEST(Constellation, GroundThatOnlyOneDriveCoveredIsNeutral) {
  Lattice lattice;
  Constellation c = lattice.constellation();
  const ConstellationScore before = score_constellation(c, lattice.truth());
  EXPECT_DOUBLE_EQ(before.ratio, 1.0);
  c.branch.push_back({5000, {0.0, 60.0}, 9});  // far from anything the old drive saw
  c.old_landmarks.push_back({5001, {{lattice.now_m, -60.0}, Eigen::Matrix2d::Identity()}});
  const ConstellationScore after = score_constellation(c, lattice.truth());
  EXPECT_EQ(after.matched, before.matched);
  EXPECT_DOUBLE_EQ(after.ratio, 1.0);
  c.branch.push_back({5002, {10.0, 0.0}, 9});  // in the middle of the road, where the old drive saw nothing
  EXPECT_EQ(score_constellation(c, lattice.truth()).unmatched_branch, 1);
  c.branch.back().hits = 2;  // too few sightings to be believed
  EXPECT_EQ(score_constellation(c, lattice.truth()).unmatched_branch, 0);
}

TEST(Constellation, RefusesALatticeWhoseShiftFitsAsWell) {
  Lattice lattice;
  lattice.entered_m = 60.0;
  lattice.now_m = 80.0;  // neither end in view
  const ConstellationVerdict verdict =
      judge_constellation(lattice.constellation(), lattice.truth(), {{75.0, 0.0, 0.0}, {85.0, 0.0, 0.0}});
  EXPECT_FALSE(verdict.accepted);
  EXPECT_EQ(verdict.reason, ConstellationReason::rival_too_good);
  EXPECT_EQ(verdict.rivals_tried, 2);
  EXPECT_GE(verdict.rival_share, 0.95);
}

/// Randomly placed trees beyond the end of a lattice, seen by both drives.
void add_scattered_end(const Lattice& lattice, int count, Constellation& c) {
  core::RandomStream random(9, "end");
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d tree(lattice.length_m + random.uniform(3.0, 35.0), random.uniform(-9.0, 9.0));
    c.old_landmarks.push_back({5000 + i, {tree, 0.01 * Eigen::Matrix2d::Identity()}});
    c.branch.push_back({6000 + i, core::transform(core::inverse(lattice.truth()), tree), 5});
  }
}

TEST(Constellation, AcceptsALatticeOnceWhatStandsAtItsEndContradictsTheShift) {
  Lattice lattice;
  lattice.entered_m = 130.0;
  lattice.now_m = 170.0;
  lattice.old_to_m = 190.0;
  Constellation c = lattice.constellation();
  std::vector<core::Pose2> shifts;
  for (const double shift : {-10.0, -5.0, 5.0, 10.0}) shifts.emplace_back(lattice.now_m + shift, 0.0, 0.0);
  EXPECT_EQ(judge_constellation(c, lattice.truth(), shifts).reason, ConstellationReason::rival_too_good);
  add_scattered_end(lattice, 10, c);
  const ConstellationVerdict verdict = judge_constellation(c, lattice.truth(), shifts);
  EXPECT_TRUE(verdict.accepted);
  EXPECT_DOUBLE_EQ(verdict.winner.ratio, 1.0);
  EXPECT_GT(verdict.rival_share, 0.2);
  EXPECT_LT(verdict.rival_share, 0.75);
}

TEST(Constellation, SaysWhichLimitRefused) {
  Lattice lattice;
  Constellation c = lattice.constellation();
  c.branch.resize(4);
  EXPECT_EQ(judge_constellation(c, lattice.truth(), {}).reason, ConstellationReason::too_few_matches);
  c = lattice.constellation();
  for (int i = 0; i < 120; ++i) c.branch.push_back({2000 + i, {-20.0 + 0.25 * i, 0.0}, 9});
  const ConstellationVerdict verdict = judge_constellation(c, lattice.truth(), {});
  EXPECT_EQ(verdict.reason, ConstellationReason::ratio_too_low);
  EXPECT_LE(verdict.winner.ratio, 0.4);
  EXPECT_EQ(verdict.rival.matched, 0);
}

TEST(Constellation, LeavesRivalsWithFewMatchesOut) {
  Lattice lattice;
  const Constellation c = lattice.constellation();
  // Far ahead, only the last trees of the row overlap: a perfect ratio on a handful is not a rival to many matches.
  const ConstellationVerdict verdict = judge_constellation(c, lattice.truth(), {{lattice.length_m + 35.0, 0.0, 0.0}});
  EXPECT_TRUE(verdict.accepted);
  EXPECT_EQ(verdict.rival.matched, 0);
}

/// A row of landmarks of two alternating classes, seen often enough on both drives.
Constellation row_of_two_classes(bool given) {
  Constellation row;
  for (int i = 0; i < 200; ++i) {
    core::Appearance one;
    one.name = core::ClassName(i % 2 == 0 ? "red" : "blue");
    row.population.count(one);
  }
  for (int i = 0; i < 8; ++i) {
    core::Appearance seen;
    seen.name = core::ClassName(i % 2 == 0 ? "red" : "blue");
    core::LandmarkAppearance known;
    for (int k = 0; k < 3 && given; ++k) known = row.population.updated(known, seen);
    row.branch.push_back({i, {5.0 * i, 0.0}, 5, known});
    row.old_landmarks.push_back({100 + i, {{5.0 * i, 0.0}, 1e-4 * Eigen::Matrix2d::Identity()}, known});
  }
  return row;
}

TEST(Constellation, OfClassesInTurnHasNoRivalOnePitchAway) {
  const core::Pose2 shifted(5.0, 0.0, 0.0);
  EXPECT_EQ(score_constellation(row_of_two_classes(false), {}).matched, 8);
  EXPECT_EQ(score_constellation(row_of_two_classes(false), shifted).matched, 7);
  EXPECT_EQ(score_constellation(row_of_two_classes(true), {}).matched, 8);
  EXPECT_EQ(score_constellation(row_of_two_classes(true), shifted).matched, 0);
  EXPECT_EQ(score_constellation(row_of_two_classes(true), {10.0, 0.0, 0.0}).matched, 6);
}

}  // namespace
}  // namespace helixnav::pf_relocalize
