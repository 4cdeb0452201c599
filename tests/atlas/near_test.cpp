// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "small_drive.hpp"

namespace helixnav::atlas {
namespace {

TEST(Near, FindsWhatBruteForceFindsAtAnyTimeOfADrive) {
  testing::SmallDriveOptions options;
  options.landmarks = 120;
  options.steps = 300;
  options.radius_m = 90.0;
  const testing::SmallDrive drive = testing::make_small_drive(20, options);
  Atlas atlas({}, Options());
  core::RandomStream random(21);
  int found = 0;
  for (const auto& log : drive.logs) {
    testing::add_phase(atlas, log);
    const std::vector<Place> all = atlas.landmarks();
    for (int trial = 0; trial < 5; ++trial) {
      const Eigen::Vector2d center_m(random.uniform(-100.0, 100.0), random.uniform(-10.0, 190.0));
      const double radius_m = random.uniform(1.0, 60.0);
      std::vector<core::LandmarkId> exact;
      for (const Place& place : all) {
        if ((place.point_m - center_m).norm() <= radius_m) exact.push_back(place.id);
      }
      std::vector<core::LandmarkId> ids;
      for (const Place& place : atlas.near(center_m, radius_m)) {
        ids.push_back(place.id);
        EXPECT_LT((place.point_m - atlas.landmark(place.id)).norm(), 1e-9);
      }
      EXPECT_EQ(ids, exact);
      found += static_cast<int>(exact.size());
    }
  }
  EXPECT_GT(found, 500);
}

}  // namespace
}  // namespace helixnav::atlas
