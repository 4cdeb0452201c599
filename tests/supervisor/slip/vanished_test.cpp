// SPDX-License-Identifier: BSD-3-Clause
#include "slip/vanished.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using core::Outcome;

constexpr double extraneous = 0.5;

/// A vehicle that sees the same landmarks in scan after scan.
struct WatchedDrive {
  /// One scan: what it matches, what it begins, and what it should have seen.
  void scan(const std::vector<LandmarkId>& matched, const std::vector<LandmarkId>& begun,
            const std::vector<LandmarkId>& expected, const std::vector<LandmarkId>& far_off = {}) {
    std::vector<core::AssociationReport> fate;
    const auto add = [&](LandmarkId id, Outcome outcome) {
      core::AssociationReport one;
      one.observation = static_cast<int>(fate.size());
      one.landmark = id;
      one.outcome = outcome;
      fate.push_back(one);
    };
    for (const LandmarkId id : matched) add(id, Outcome::matched);
    for (const LandmarkId id : begun) add(id, Outcome::augmented);
    watched.see(step++, watched.sensor_of(by), fate, {expected, far_off}, life, extraneous, 0,
                [this](const std::vector<LandmarkId>&) { return by_chance; });
    life.observe({static_cast<double>(step), 0.0}, matched, begun, {});
  }

  void pass_quietly(const std::vector<LandmarkId>& all, int scans) {
    scan({}, all, all);
    for (int k = 1; k < scans; ++k) scan(all, {}, all);
  }

  SeenAgain watched;
  core::Scan by;  ///< the sensor's mounting and view
  association::LandmarkLife life;
  std::int64_t step = 0;
  double by_chance = 0.0;  ///< that a landmark is matched in another place
};

const std::vector<LandmarkId> known = {0, 1, 2, 3, 4, 5};
const std::vector<LandmarkId> nothing = {};
const std::vector<LandmarkId> unknown = {10, 11, 12, 13, 14, 15};

TEST(SeenAgain, BelievesASlipOnceWhatVanishedStaysAwayAndWhatCameIsThere) {
  WatchedDrive drive;
  drive.pass_quietly(known, 50);
  EXPECT_FALSE(drive.watched.is_suspicious());
  drive.scan({}, unknown, known);
  EXPECT_TRUE(drive.watched.is_suspicious());
  EXPECT_EQ(drive.watched.lost(), nullptr) << "one scan is not enough";
  drive.scan(unknown, {}, known);
  ASSERT_NE(drive.watched.lost(), nullptr);
  EXPECT_EQ(drive.watched.lost()->step, 50);
  EXPECT_EQ(drive.watched.lost()->missing, known);
  EXPECT_EQ(drive.watched.lost()->unknown, unknown);
}

TEST(SeenAgain, IsNoLongerSuspiciousOnceMoreAreBackThanByChance) {
  WatchedDrive drive;
  drive.pass_quietly(known, 50);
  drive.scan({}, unknown, known);
  drive.scan({1, 2, 3, 10, 11, 12}, {}, known);
  EXPECT_FALSE(drive.watched.is_suspicious());
  EXPECT_EQ(drive.watched.lost(), nullptr);
}

/// In a forest one stem stands where another should be.
TEST(SeenAgain, IsNotReassuredByOneMatchAmongMany) {
  WatchedDrive drive;
  drive.pass_quietly(known, 50);
  drive.scan({}, unknown, known);
  drive.scan({2, 10, 11, 12, 13}, {}, known);
  EXPECT_NE(drive.watched.lost(), nullptr);
}

/// Where a gate holds something nearly anywhere, a match says nothing, and the landmarks that stay away decide.
TEST(SeenAgain, IsNotReassuredByMatchesThatChanceExplains) {
  for (const bool is_crowded : {false, true}) {
    WatchedDrive drive;
    drive.pass_quietly(known, 50);
    drive.scan({}, unknown, known);
    drive.by_chance = is_crowded ? 0.5 : 0.01;
    drive.scan({2, 3, 10, 11, 12, 13}, {}, {2, 3, 4, 5});
    EXPECT_EQ(drive.watched.lost() != nullptr, is_crowded);
  }
}

/// Most of what a scan saw is farther off than landmarks are seen reliably.
TEST(SeenAgain, MissesWhatIsSeenLessReliablyToo) {
  WatchedDrive drive;
  const std::vector<LandmarkId> near_by = {0}, far_off = {1, 2, 3, 4, 5};
  drive.scan({}, known, near_by, far_off);
  for (int k = 1; k < 50; ++k) drive.scan(known, {}, near_by, far_off);
  drive.scan({}, unknown, near_by, far_off);
  EXPECT_TRUE(drive.watched.is_suspicious());
  drive.scan(unknown, {}, near_by, far_off);
  ASSERT_NE(drive.watched.lost(), nullptr);
  EXPECT_EQ(drive.watched.lost()->missing, known);
}

TEST(SeenAgain, DoesNotSuspectWhereSomeAreSeenAgain) {
  WatchedDrive drive;
  drive.pass_quietly(known, 50);
  drive.scan({0, 1, 2}, unknown, known);
  EXPECT_FALSE(drive.watched.is_suspicious()) << "a lorry stops in front of the others";
}

TEST(SeenAgain, DoesNotSuspectWhereNothingCameInstead) {
  WatchedDrive drive;
  drive.pass_quietly(known, 50);
  drive.scan({}, {}, known);
  EXPECT_FALSE(drive.watched.is_suspicious()) << "a sensor that was blinded";
}

/// A second sensor looks back, and takes a scan after each of the first's.
TEST(SeenAgain, AsksEachSensorForWhatItSawItself) {
  WatchedDrive drive;
  const std::vector<LandmarkId> behind = {20, 21};
  const auto look_back = [&](const std::vector<LandmarkId>& seen, const std::vector<LandmarkId>& begun) {
    drive.by.T_robot_sensor.heading_rad = 3.0;
    drive.scan(seen, begun, drive.watched.is_suspicious() ? std::vector<LandmarkId>{} : behind);
    drive.by.T_robot_sensor.heading_rad = 0.0;
  };
  drive.scan({}, known, known);
  look_back({}, behind);
  for (int k = 0; k < 50; ++k) {
    drive.scan(known, {}, known);
    look_back(behind, {});
  }
  drive.scan({}, unknown, known);
  EXPECT_TRUE(drive.watched.is_suspicious());
  for (int k = 0; k < 4; ++k) look_back({}, {});
  EXPECT_TRUE(drive.watched.is_suspicious()) << "scans that look elsewhere decide nothing";
  drive.scan(unknown, {}, known);
  ASSERT_NE(drive.watched.lost(), nullptr);
  EXPECT_EQ(drive.watched.lost()->missing, known);
}

/// A search leaves known landmarks out, so that no scan can match them.
TEST(SeenAgain, DoesNotMissWhatASearchLeavesOut) {
  for (const bool is_left_out : {false, true}) {
    WatchedDrive drive;
    drive.pass_quietly(known, 50);
    if (is_left_out) drive.watched.leave_out(known);
    drive.scan({}, unknown, known);
    EXPECT_EQ(drive.watched.is_suspicious(), !is_left_out);
  }
}

/// Once the vehicle has been found lost, and again once it is carried on from there.
TEST(SeenAgain, ExpectsOnlyWhatWasSeenSinceItForgot) {
  WatchedDrive drive;
  drive.pass_quietly(known, 50);
  drive.watched.forget();
  for (int k = 0; k < 4; ++k) {
    drive.scan(k > 0 ? unknown : nothing, k > 0 ? nothing : unknown, known);
    EXPECT_FALSE(drive.watched.is_suspicious()) << k;
  }
  drive.scan({}, {20, 21, 22, 23}, unknown);
  EXPECT_TRUE(drive.watched.is_suspicious());
}

TEST(SeenAgain, StopsSuspectingWhatNoScanDecides) {
  WatchedDrive drive;
  drive.pass_quietly(known, 50);
  drive.scan({}, unknown, known);
  for (int k = 0; k < 3; ++k) drive.scan({}, {}, known);
  EXPECT_FALSE(drive.watched.is_suspicious());
}

}  // namespace
}  // namespace helixnav::supervisor
