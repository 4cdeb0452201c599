// SPDX-License-Identifier: BSD-3-Clause
#include "noise/noise_pairs.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/observation.hpp"

namespace helixnav::supervisor {
namespace {

core::Scan scan_of(const std::vector<Eigen::Vector2d>& points_m) {
  core::Scan scan;
  for (const Eigen::Vector2d& point_m : points_m) {
    core::Observation observation;
    observation.kind = core::ObservationKind::range_bearing;
    observation.z = Eigen::Vector2d(point_m.norm(), std::atan2(point_m.y(), point_m.x()));
    observation.R = Eigen::Vector2d(1e-4, 1e-6).asDiagonal();
    scan.observations.push_back(observation);
  }
  return scan;
}

cekf::CompressedEkf mapped(const std::vector<Eigen::Vector2d>& points_m) {
  cekf::CompressedEkf filter({{}, 1e-6 * Eigen::Matrix3d::Identity()});
  for (const core::Observation& observation : scan_of(points_m).observations) filter.augment(observation, {});
  return filter;
}

const std::vector<Eigen::Vector2d> trees{{10, 0}, {0, 12}, {-8, -8}};

TEST(NoisePairs, FindWhatNoGateWouldLetThrough) {
  const auto pairs = noise_pairs(mapped(trees), scan_of({{10.8, 0.5}, {0.4, 11.2}, {-8.5, -7.5}}));
  ASSERT_EQ(pairs.size(), 3U);
  for (const NoisePair& pair : pairs) EXPECT_EQ(pair.landmark, pair.seen.observation);
}

TEST(NoisePairs, LeaveOutWhatMayBeAnother) {
  std::vector<Eigen::Vector2d> twins = trees;
  twins.emplace_back(11.5, 0.0);
  const auto pairs = noise_pairs(mapped(twins), scan_of({{10.6, 0.2}, {0.4, 11.2}}));
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs.front().landmark, 1);
}

TEST(NoisePairs, LeaveOutWhatOtherObservationsMayBe) {
  EXPECT_TRUE(noise_pairs(mapped(trees), scan_of({{10.4, 0.0}, {9.4, 0.0}})).empty());
}

TEST(NoisePairs, SayHowFarApartTheyCouldBe) {
  std::vector<Eigen::Vector2d> row = trees;
  row.emplace_back(10.8, 0.0);
  const auto pairs = noise_pairs(mapped(row), scan_of({{10.05, 0.0}, {0.0, 12.1}}));
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_NEAR(pairs[0].limit_m, 0.75 / 4.0, 1e-3) << "a quarter of the way to the next";
  EXPECT_TRUE(is_fair(pairs[0], 0.08 * 0.08 * Eigen::Matrix2d::Identity()));
  EXPECT_FALSE(is_fair(pairs[0], 0.09 * 0.09 * Eigen::Matrix2d::Identity()));
  EXPECT_FALSE(is_fair(pairs[0], Eigen::Vector2d(1e-6, 0.09 * 0.09).asDiagonal())) << "in one direction";
  EXPECT_TRUE(is_fair(pairs[1], 0.09 * 0.09 * Eigen::Matrix2d::Identity()));
}

TEST(SidesSeen, CountHalfARadianApart) {
  SidesSeen sides;
  EXPECT_FALSE(sides.is_new_side(4, 3.0)) << "the look that began it";
  EXPECT_FALSE(sides.is_new_side(4, -3.0)) << "0.28 rad farther round";
  EXPECT_TRUE(sides.is_new_side(4, -2.7));
  EXPECT_FALSE(sides.is_new_side(4, -2.7));
}

TEST(SidesSeen, ForgetWhatWasLongOutOfView) {
  SidesSeen sides;
  sides.is_new_side(4, 0.0);
  for (int scan = 0; scan < 300; ++scan) sides.next_scan();
  EXPECT_FALSE(sides.is_new_side(4, 2.0));
}

}  // namespace
}  // namespace helixnav::supervisor
