// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "helixnav/smoothing/marginals.hpp"
#include "small_drive.hpp"

namespace helixnav::atlas {
namespace {

TEST(Atlas, SettledWithoutThresholdsIsTheOptimumOfAllMeasurements) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    testing::SmallDrive drive = testing::make_small_drive(seed);
    const Atlas atlas = testing::driven(drive);
    const double chi2 = testing::solve(drive.problem);
    EXPECT_NEAR(atlas.chi2(), chi2, 1e-6);
    const std::vector<core::Pose2> clones = atlas.clones();
    ASSERT_EQ(clones.size(), drive.pose_of_clone.size());
    for (std::size_t k = 0; k < clones.size(); ++k) {
      const auto& pose = drive.problem.graph.poses[static_cast<std::size_t>(drive.pose_of_clone[k])].T_world_robot;
      EXPECT_LT((clones[k].vector() - pose.vector()).norm(), 1e-6) << k;
    }
    for (const auto& landmark : drive.problem.graph.landmarks) {
      EXPECT_LT((atlas.landmark(static_cast<core::LandmarkId>(landmark.name)) - landmark.point_m).norm(), 1e-6);
    }
  }
}

}  // namespace
}  // namespace helixnav::atlas
