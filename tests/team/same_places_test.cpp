// SPDX-License-Identifier: BSD-3-Clause
#include "same_places.hpp"

#include <gtest/gtest.h>

namespace helixnav::team {
namespace {

/// Two maps of the same `n` landmarks, 3 m apart; the second is off by a common shift and by noise of its own.
Places two_maps(int n, double shift_m, double common_sigma_m, double own_sigma_m) {
  Places places;
  const auto all = static_cast<std::size_t>(2 * n);
  places.covariance = own_sigma_m * own_sigma_m * Eigen::MatrixXd::Identity(4 * n, 4 * n);
  for (std::size_t k = 0; k < all; ++k) {
    const bool second = k >= all / 2;
    const auto place = static_cast<double>(k % static_cast<std::size_t>(n));
    places.ids.push_back(static_cast<core::LandmarkId>(k));
    places.at_m.emplace_back(3.0 * place + (second ? shift_m : 0.0), place * place);
    places.density_per_m2.push_back(0.05);
  }
  for (Eigen::Index i = 2 * n; i < 4 * n; ++i) {
    for (Eigen::Index j = 2 * n; j < 4 * n; ++j) {
      if ((i - j) % 2 == 0) places.covariance(i, j) += common_sigma_m * common_sigma_m;
    }
  }
  places.are_two = [n](std::size_t i, std::size_t j) {
    return (i < static_cast<std::size_t>(n)) == (j < static_cast<std::size_t>(n));  // landmarks of one map are distinct
  };
  return places;
}

constexpr double probability = 0.999;

TEST(SamePlaces, FindsThePairsOfTwoMapsShiftedAgainstEachOther) {
  const std::vector<SamePlace> same = same_places(two_maps(5, 0.3, 0.3, 0.05), probability);
  ASSERT_EQ(same.size(), 5u);
  for (const SamePlace& pair : same) EXPECT_EQ(pair.removed, pair.kept + 5);
  EXPECT_GT(same.back().nats, same.front().nats);  // the first tells the shift, which all others share
}

TEST(SamePlaces, TwoMapsThatDisagreeShareNothing) {
  EXPECT_TRUE(same_places(two_maps(5, 1.4, 0.1, 0.05), probability).empty());
}

TEST(SamePlaces, ATwinThatMayBeItAsWellLeavesBoth) {
  Places places = two_maps(1, 0.0, 0.2, 0.05);
  places.at_m.emplace_back(0.16, 0.0);  // beside landmark 0, in the same map
  places.ids.push_back(2);
  places.density_per_m2.push_back(0.05);
  places.covariance.conservativeResizeLike(Eigen::MatrixXd::Zero(6, 6));
  places.covariance.bottomRightCorner<2, 2>() = 0.0025 * Eigen::Matrix2d::Identity();
  places.are_two = [](std::size_t i, std::size_t j) { return i + j == 2; };  // 0 and 2
  EXPECT_TRUE(same_places(places, probability).empty());
}

TEST(SamePlaces, OnePairOfBadlyKnownPlacesIsNoEvidence) {
  EXPECT_TRUE(same_places(two_maps(1, 0.0, 0.5, 0.05), probability).empty());
}

TEST(SamePlaces, WhatOneScanShowedApartIsTwo) {
  Places places = two_maps(3, 0.0, 0.0, 0.05);
  places.are_two = [](std::size_t, std::size_t) { return true; };
  EXPECT_TRUE(same_places(places, probability).empty());
}

}  // namespace
}  // namespace helixnav::team
