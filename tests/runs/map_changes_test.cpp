// SPDX-License-Identifier: BSD-3-Clause
#include "map_changes.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::runs {
namespace {

core::MapLandmark landmark_at(core::LandmarkId id, double x_m, double y_m) {
  core::MapLandmark landmark;
  landmark.id = id;
  landmark.point = {{x_m, y_m}, Eigen::Matrix2d::Identity() * 0.01};
  landmark.state = core::LandmarkState::mature;
  return landmark;
}

std::vector<core::LandmarkId> ids_of(const std::vector<core::MapLandmark>& map) {
  std::vector<core::LandmarkId> ids;
  for (const core::MapLandmark& landmark : map) ids.push_back(landmark.id);
  return ids;
}

TEST(MapChanges, TellWhatBeganMovedAndWent) {
  MapChanges changes(100);
  EXPECT_EQ(ids_of(changes.since_last(0, {landmark_at(1, 0, 0), landmark_at(2, 5, 0)}).changed),
            (std::vector<core::LandmarkId>{1, 2}));
  const MapChange second =
      changes.since_last(10, {landmark_at(1, 0.05, 0), landmark_at(2, 5.01, 0), landmark_at(4, 9, 9)});
  EXPECT_EQ(ids_of(second.changed), (std::vector<core::LandmarkId>{1, 4}));
  EXPECT_TRUE(second.removed.empty());
  const MapChange third = changes.since_last(20, {landmark_at(2, 5.021, 0)});
  EXPECT_EQ(ids_of(third.changed), std::vector<core::LandmarkId>{2}) << "against what was told, not what was last seen";
  EXPECT_EQ(third.removed, (std::vector<core::LandmarkId>{1, 4}));
}

TEST(MapChanges, LookSomeHundredTimesADriveAndWhereTheMapMoved) {
  const MapChanges changes(100'000);
  core::StepReport report;
  int looks = 0;
  for (report.step = 0; report.step < 100'000; ++report.step) looks += changes.wants(report) ? 1 : 0;
  EXPECT_EQ(looks, 400);
  report.step = 7;
  EXPECT_FALSE(changes.wants(report));
  report.solved = {{0, {}}};
  EXPECT_TRUE(changes.wants(report));
}

// A hundred refusals and closings that each turn the map by metres must not fill the report with its history.
TEST(MapChanges, TellLessOfAMapThatMovesAllTheTime) {
  MapChanges changes(100'000);
  core::RandomStream random(1, "moving map");
  std::size_t told = 0;
  for (int look = 0; look < 400; ++look) {
    std::vector<core::MapLandmark> map;
    for (int id = 0; id < 3000; ++id) {
      map.push_back(landmark_at(id, random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)));
    }
    told += changes.since_last(look, map).changed.size();
  }
  EXPECT_LT(told, 300'000u);
  EXPECT_GT(told, 100'000u);
}

}  // namespace
}  // namespace helixnav::runs
