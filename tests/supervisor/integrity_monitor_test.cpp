// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/sim/world.hpp"
#include "integrity/integrity_monitor.hpp"

namespace helixnav::supervisor {
namespace {

using Ids = std::vector<core::LandmarkId>;

constexpr double old_after_m = 60.0;

/// Mature landmarks 0 to n−1, last seen at the beginning of a drive of `driven_m`.
association::LandmarkLife existence_of(int n, double driven_m) {
  association::LandmarkLife life;
  Ids all;
  for (int i = 0; i < n; ++i) all.push_back(i);
  life.observe({0.0, 0.0}, {}, all, {});
  for (int look = 1; look <= 5; ++look) life.observe({1.0 * look, 0.0}, all, {}, {});
  life.drive(driven_m);
  return life;
}

/// Looks for them in this many scans, a metre apart.
void look(IntegrityMonitor& monitor, association::LandmarkLife& life, int scans, const Ids& expected,
          const Ids& matched) {
  for (int i = 0; i < scans; ++i) {
    monitor.observe(life, expected, matched, old_after_m);
    life.drive(1.0);
  }
}

/// Landmarks from `first` on are born and mature.
void spawn(association::LandmarkLife& life, core::LandmarkId first, int n) {
  Ids born;
  for (int i = 0; i < n; ++i) born.push_back(first + i);
  life.observe({100.0, 0.0}, {}, born, {});
  for (int look = 1; look <= 5; ++look) life.observe({100.0 + look, 0.0}, born, {}, {});
}

TEST(IntegrityMonitor, CountsEachLandmarkOnceHoweverOftenItIsLookedFor) {
  association::LandmarkLife life = existence_of(5, 100.0);
  IntegrityMonitor monitor;
  look(monitor, life, 2, {0, 1}, {});
  EXPECT_EQ(monitor.evidence(life, {}).missing, 0);
  look(monitor, life, 50, {0, 1, 2}, {2});
  const IntegrityMonitor::Evidence evidence = monitor.evidence(life, {});
  EXPECT_EQ(evidence.missing, 2);
  EXPECT_EQ(evidence.seen, 1);
  EXPECT_DOUBLE_EQ(evidence.nats, 2 * 1.1 - 1.95);
}

TEST(IntegrityMonitor, IsLostWhereFourAreMissingAndTwoSpawn) {
  association::LandmarkLife life = existence_of(5, 100.0);
  IntegrityMonitor monitor;
  look(monitor, life, 3, {0, 1, 2, 3}, {});
  EXPECT_FALSE(monitor.is_lost(life, {})) << "nothing is seen: the sensor may be covered";
  spawn(life, 10, 2);
  EXPECT_TRUE(monitor.is_lost(life, {}));
}

TEST(IntegrityMonitor, AFelledThirdDoesNotAccuseThePose) {
  association::LandmarkLife life = existence_of(9, 100.0);
  IntegrityMonitor monitor;
  for (const core::LandmarkId standing : {0, 1, 2, 3, 4, 5}) look(monitor, life, 4, {standing, 6, 7, 8}, {standing});
  spawn(life, 10, 3);
  EXPECT_EQ(monitor.evidence(life, {}).missing, 3);
  EXPECT_FALSE(monitor.is_lost(life, {}));
}

TEST(IntegrityMonitor, TwoMatchesInEachOfTwoScansInARowConfirmThePose) {
  association::LandmarkLife life = existence_of(6, 100.0);
  IntegrityMonitor monitor;
  EXPECT_TRUE(monitor.is_clear());
  look(monitor, life, 3, {0, 1, 2, 3}, {});
  EXPECT_FALSE(monitor.is_clear());
  look(monitor, life, 1, {0, 1, 2, 3, 4, 5}, {4, 5});
  EXPECT_FALSE(monitor.is_clear()) << "clutter may do that";
  look(monitor, life, 1, {0, 1, 2, 3, 4, 5}, {3, 5});
  EXPECT_TRUE(monitor.is_clear());
  spawn(life, 10, 2);
  EXPECT_EQ(monitor.evidence(life, {}).missing, 0);
  look(monitor, life, 1, {4}, {4});
  EXPECT_FALSE(monitor.is_clear()) << "one match confirms nothing";
}

TEST(IntegrityMonitor, AClosingConfirmsThePoseByTheLandmarksThatItRecognised) {
  association::LandmarkLife life = existence_of(9, 100.0);
  const Ids recognised{0, 1, 2, 3, 4};
  spawn(life, 10, 2);
  life.observe({110.0, 0.0}, recognised, {}, {});  // as a merge records them
  association::LandmarkLife later = life;
  const auto drive_on = [&](IntegrityMonitor monitor) {
    later = life;
    EXPECT_TRUE(monitor.is_clear());
    look(monitor, later, 3, {0, 1, 5, 6, 7, 8}, {0, 1});
    spawn(later, 20, 2);
    return monitor;
  };
  EXPECT_TRUE(drive_on(IntegrityMonitor()).is_lost(later, {})) << "those that were felled are all that it knows of";
  IntegrityMonitor closed;
  closed.close(life.path_m(), recognised);
  EXPECT_FALSE(drive_on(closed).is_lost(later, {}));
  EXPECT_TRUE(drive_on(closed).is_clear());
  EXPECT_EQ(closed.evidence(life, {}).spawned, 0) << "what was born in the search is not held against the closing";
  association::LandmarkLife existence = life;
  look(closed, existence, 3, {0, 1, 2, 5, 6}, {});
  spawn(existence, 20, 2);
  EXPECT_TRUE(closed.is_lost(existence, {})) << "and it may be wrong";
}

TEST(IntegrityMonitor, CountsNothingAsSpawnedThatWasThereWhenItBegan) {
  association::LandmarkLife life = existence_of(6, 100.0);
  IntegrityMonitor monitor;
  look(monitor, life, 5, {0, 1, 2, 3}, {});  // never clear
  EXPECT_EQ(monitor.evidence(life, {}).spawned, 0);
  EXPECT_FALSE(monitor.is_lost(life, {}));
  spawn(life, 20, 2);
  EXPECT_EQ(monitor.evidence(life, {}).spawned, 2);
  EXPECT_TRUE(monitor.is_lost(life, {}));
}

TEST(IntegrityMonitor, WhatWasSeenLatelyTellsNothingOfAReturn) {
  association::LandmarkLife life = existence_of(4, 30.0);
  IntegrityMonitor monitor;
  look(monitor, life, 10, {0, 1, 2, 3}, {});
  EXPECT_EQ(monitor.evidence(life, {}).missing, 0);
  EXPECT_TRUE(monitor.is_clear());
}

/// Seeds of sparse worlds in which a wrong match, long after a correct closing, turned the pose for good.
class WrongMatch : public testing::TestWithParam<std::uint64_t> {};

struct End {
  double nees = 0.0;
  int rolled_back = 0;
  std::vector<core::LandmarkId> born;
};

End end_of(std::uint64_t seed, bool missing_spawn) {
  const core::Recording run = sim::simulate(sim::named_scenario("sparse"), seed);
  NavigatorOptions options;
  options.search.relocalizer.threads = 1;
  options.search.seed = seed;
  options.search.integrity.enabled = missing_spawn;
  Navigator navigator(run.start, options);
  End end;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    const core::StepReport report = navigator.observe(scan);
    EXPECT_EQ(report.step, static_cast<std::int64_t>(i));
    for (const core::Decision& d : report.decisions)
      end.rolled_back += std::holds_alternative<core::RollbackDecision>(d);
    const auto note = [&](const std::vector<core::AssociationReport>& associations) {
      for (const auto& a : associations) {
        if (a.outcome == core::Outcome::augmented) end.born.push_back(a.landmark);
      }
    };
    for (const core::RevisedScan& revised : report.revised) note(revised.associations);
    note(report.associations);
    end.nees = nees(report.pose, run.true_poses[i].T_world_robot);
  });
  return end;
}

TEST_P(WrongMatch, IsUndoneByASearchFromBefore) {
  const End lost = end_of(GetParam(), false);
  EXPECT_EQ(lost.rolled_back, 0);
  const double band = core::chi2_quantile(0.999, 3);
  EXPECT_GT(lost.nees, band);
  End found = end_of(GetParam(), true);
  EXPECT_GE(found.rolled_back, 1);
  EXPECT_LT(found.nees, band);
  std::sort(found.born.begin(), found.born.end());
  EXPECT_EQ(std::adjacent_find(found.born.begin(), found.born.end()), found.born.end()) << "an id was given twice";
}

INSTANTIATE_TEST_SUITE_P(Seeds, WrongMatch, testing::Values(2199));

/// Clutter at two places in the gate of one old landmark was a match there, until two hits had to agree with each other.
TEST(WrongMatch, IsNotMadeByTwoHitsAtDifferentPlaces) {
  EXPECT_LT(end_of(1786, false).nees, core::chi2_quantile(0.999, 3));
}

}  // namespace
}  // namespace helixnav::supervisor
