// SPDX-License-Identifier: BSD-3-Clause
#include "looks.hpp"

#include <gtest/gtest.h>

#include "same_places.hpp"

namespace helixnav::team {
namespace {

/// Looks of one robot, in these scans.
Looks looks_in(std::initializer_list<std::int64_t> scans, std::size_t robot = 0) {
  Looks looks;
  for (const std::int64_t scan : scans) looks.scans.emplace_back(robot, scan);
  return looks;
}

TEST(Looks, TakenNowByOneAndNowByTheOtherAreInTurn) {
  EXPECT_TRUE(were_seen_in_turn(looks_in({1, 3, 4, 7, 9}), looks_in({2, 5, 6, 8})));
  EXPECT_FALSE(were_seen_in_turn(looks_in({1, 2, 5}), looks_in({3, 4, 6}))) << "three turns may be chance";
}

TEST(Looks, AtOneAfterTheOtherHasGoneAreNotInTurn) {
  EXPECT_FALSE(were_seen_in_turn(looks_in({1, 2, 3, 4, 5, 6}), looks_in({7, 8, 9, 10, 11, 12})));
  EXPECT_FALSE(were_seen_in_turn(looks_in({1, 11, 21, 31, 41}), looks_in({6, 16, 26, 36, 46}))) << "scans lie between";
  EXPECT_FALSE(were_seen_in_turn(looks_in({1, 3, 5, 7, 9}, 0), looks_in({2, 4, 6, 8, 10}, 1))) << "of two robots";
}

TEST(Looks, OfWhatOneScanShowsTogetherAreNotInTurn) {
  EXPECT_FALSE(were_seen_in_turn(looks_in({1, 3, 4, 6, 8, 10}), looks_in({2, 4, 5, 6, 7, 9})));
}

/// Two copies of one landmark, 80 looks of 0.05 m each, each with one half of the noise: their means are 1.6 σ of a
/// look apart, ten times what their covariances allow.
TEST(Looks, SharedOutBetweenTwoCopiesPutThemApart) {
  Places places;
  places.ids = {0, 1};
  places.at_m = {{-0.04, 0.0}, {0.04, 0.0}};
  places.covariance = 0.05 * 0.05 / 80.0 * Eigen::Matrix4d::Identity();
  places.density_per_m2 = {0.05, 0.05};
  places.are_two = [](std::size_t, std::size_t) { return false; };
  EXPECT_TRUE(same_places(places, 0.0).empty());
  places.split_m2 = {0.05 * 0.05, 0.05 * 0.05};
  EXPECT_EQ(same_places(places, 0.0).size(), 1u);
}

}  // namespace
}  // namespace helixnav::team
