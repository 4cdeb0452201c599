// SPDX-License-Identifier: BSD-3-Clause
#include "closing/mapped_twice.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace helixnav::supervisor {
namespace {

/// The same ground mapped in several passes, each off by as much along x and known to sigma_m relative to the one before.
struct MappedInPasses {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  std::vector<core::LandmarkId> all;

  MappedInPasses(const std::vector<Eigen::Vector2d>& points_m, int passes, double offset_m, double sigma_m) {
    const Eigen::Matrix2d R = 1e-4 * Eigen::Matrix2d::Identity();
    for (int pass = 0; pass < passes; ++pass) {
      if (pass > 0) drift(sigma_m);
      for (const Eigen::Vector2d& p : points_m) {
        all.push_back(filter.augment(core::make_cartesian(p + Eigen::Vector2d(pass * offset_m, 0.0), R), {}));
      }
    }
  }

  void drift(double sigma_m) {
    core::Odometry odometry;
    odometry.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, 1e-10;
    filter.predict(odometry);
  }

  KeptRemoved found() const { return mapped_twice(filter, all, {}); }
};

std::vector<Eigen::Vector2d> in_a_row(int n, double pitch_m) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < n; ++i) points.emplace_back(5.0 + pitch_m * i, 0.0);
  return points;
}

TEST(MappedTwice, AreTheCopiesOfEachLandmarkWithItsFirst) {
  const MappedInPasses map(in_a_row(5, 5.0), 3, 0.2, 0.2);
  const KeptRemoved pairs = map.found();
  ASSERT_EQ(pairs.size(), 10u);
  for (const auto& [kept, removed] : pairs) {
    EXPECT_LT(kept, map.all[5]) << "the first pass is kept";
    EXPECT_EQ((removed - kept) % 5, 0) << "a copy went to another's original";
  }
}

TEST(MappedTwice, IsNothingThatWasSeenInOneScan) {
  EXPECT_TRUE(MappedInPasses({{5.0, 0.0}, {5.3, 0.0}, {9.0, 2.0}}, 1, 0.0, 0.0).found().empty()) << "twin stems";
}

TEST(MappedTwice, IsNothingThatMayBeItsNeighbour) {
  EXPECT_TRUE(MappedInPasses(in_a_row(5, 2.0), 2, 0.2, 1.0).found().empty());
  EXPECT_TRUE(MappedInPasses(in_a_row(5, 4.6), 2, 2.3, 1.0).found().empty()) << "half-way to the next";
}

/// A, B and C in a line: A and B may be one, and B and C, but not A and C.
TEST(MappedTwice, IsNoChain) {
  const MappedInPasses map(in_a_row(1, 1.0), 3, 0.55, 0.2);
  EXPECT_TRUE(map.found().empty());
}

TEST(MappedTwice, AreOneAfterMergingThem) {
  MappedInPasses map(in_a_row(4, 6.0), 2, 0.15, 0.3);
  map.filter.merge(map.found());
  std::vector<core::LandmarkId> left = map.filter.landmarks();
  EXPECT_EQ(left.size(), 4u);
  EXPECT_TRUE(mapped_twice(map.filter, left, {}).empty());
}

}  // namespace
}  // namespace helixnav::supervisor
