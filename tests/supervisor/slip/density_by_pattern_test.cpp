// SPDX-License-Identifier: BSD-3-Clause
// How densely a map coincides with itself when it is displaced.
#include "slip/density_by_pattern.hpp"

#include <gtest/gtest.h>

#include "slip_scene.hpp"

namespace helixnav::supervisor {
namespace {

const Eigen::Matrix2d seen_m2 = 0.01 * Eigen::Matrix2d::Identity();

std::vector<Eigen::Vector2d> square(int side, double pitch_m) {
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < side; ++i) {
    for (int k = 0; k < side; ++k) points_m.emplace_back(pitch_m * i, pitch_m * k);
  }
  return points_m;
}

/// Largest density of a difference of two landmarks of 0.05 m, seen with 0.1 m.
const double largest_per_m2 = 1.0 / (2.0 * core::pi * (0.01 + 2.0 * 0.0025));

TEST(DensityByPattern, OfALatticeMovedByAPitchIsThatOfAPairThatFits) {
  const RelativeGeometry geometry(SlipScene::joint_of(square(6, 5.0)));
  const double per_m2 = DensityByPattern(geometry, {5.0, 0.0, 0.0}).per_m2(seen_m2);
  EXPECT_NEAR(per_m2, largest_per_m2 * 30.0 / 32.0, 1e-3 * largest_per_m2)
      << "30 of 36 on others, 6 beyond the map, and 2 of the prior";
}

TEST(DensityByPattern, OfALatticeMovedByHalfAPitchIsNone) {
  const RelativeGeometry geometry(SlipScene::joint_of(square(6, 5.0)));
  EXPECT_LT(DensityByPattern(geometry, {2.5, 0.0, 0.0}).per_m2(seen_m2), 1e-12);
}

TEST(DensityByPattern, OfAScatteredMapIsThatOfAccident) {
  double sum_per_m2 = 0.0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const RelativeGeometry geometry(SlipScene::joint_of(scattered(seed, 16)));
    sum_per_m2 += DensityByPattern(geometry, {3.0, 2.0, 0.1}).per_m2(seen_m2);
  }
  const double landmarks_per_m2 = 16.0 / (26.0 * 36.0);
  EXPECT_LT(sum_per_m2 / 50.0, 2.0 * landmarks_per_m2);
}

TEST(DensityByPattern, OfFewLandmarksIsThatOfThePrior) {
  const RelativeGeometry geometry(SlipScene::joint_of({{0.0, 0.0}}));
  EXPECT_EQ(DensityByPattern(geometry, {5.0, 0.0, 0.0}).per_m2(seen_m2), 0.0);
}

}  // namespace
}  // namespace helixnav::supervisor
