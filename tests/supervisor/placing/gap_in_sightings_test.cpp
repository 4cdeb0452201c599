// SPDX-License-Identifier: BSD-3-Clause
#include "placing/gap_in_sightings.hpp"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;

/// A drive with a scan every metre.
struct SeenOnADrive {
  void scan(const std::vector<LandmarkId>& seen, const std::vector<LandmarkId>& begun) {
    life.drive(1.0);
    life.observe({life.path_m(), 0.0}, seen, begun, {});
  }
  association::LandmarkLife life;
};

/// Ten scans of five landmarks each: the next street, whose landmarks are new.
void see_street(SeenOnADrive& drive, LandmarkId first, const std::vector<LandmarkId>& by_chance = {}) {
  const std::vector<LandmarkId> street = {first, first + 1, first + 2, first + 3, first + 4};
  drive.scan(by_chance, street);
  for (int k = 1; k < 10; ++k) drive.scan(street, {});
}

TEST(GapInSightings, IsWhereAllLandmarksAreNew) {
  SeenOnADrive drive;
  see_street(drive, 0);
  see_street(drive, 10);
  const std::optional<SightingGap> gap = gap_in_sightings(drive.life, 1.0, 20.0);
  ASSERT_TRUE(gap.has_value());
  EXPECT_EQ(gap->first_m, 11.0) << "the scan that begins the second street";
  EXPECT_EQ(gap->last_m, 11.0);
  EXPECT_EQ(gap->across, 0);
  EXPECT_EQ(gap->since, 5);
}

TEST(GapInSightings, IsAlsoFoundWhereOneOfThoseBeforeIsMatchedByChance) {
  SeenOnADrive drive;
  see_street(drive, 0);
  see_street(drive, 10, {2});
  const std::optional<SightingGap> gap = gap_in_sightings(drive.life, 1.0, 20.0);
  ASSERT_TRUE(gap.has_value());
  EXPECT_EQ(gap->last_m, 11.0);
  EXPECT_EQ(gap->across, 1);
  EXPECT_EQ(gap->since, 6);
}

/// A bare street after it was carried is such a place as well, and which of the two it was nobody knows.
TEST(GapInSightings, TellsTheFirstAndTheLastOfSeveral) {
  SeenOnADrive drive;
  for (const LandmarkId first : {0, 10, 20}) see_street(drive, first);
  const std::optional<SightingGap> gap = gap_in_sightings(drive.life, 1.0, 30.0);
  ASSERT_TRUE(gap.has_value());
  EXPECT_EQ(gap->first_m, 11.0);
  EXPECT_EQ(gap->last_m, 21.0);
  EXPECT_EQ(gap->since, 5);
  const std::optional<SightingGap> sooner = gap_in_sightings(drive.life, 1.0, 20.0);
  ASSERT_TRUE(sooner.has_value());
  EXPECT_EQ(sooner->last_m, 11.0) << "what is sought was begun before the other";
}

TEST(GapInSightings, IsNothingWhereNoLandmarkWasBegun) {
  SeenOnADrive drive;
  see_street(drive, 0);
  EXPECT_FALSE(gap_in_sightings(drive.life, 1.0, 20.0).has_value());
}

}  // namespace
}  // namespace helixnav::supervisor
