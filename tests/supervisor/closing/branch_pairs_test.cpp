// SPDX-License-Identifier: BSD-3-Clause
#include "closing/branch_pairs.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace helixnav::supervisor {
namespace {

/// Old landmarks, and their copies seen from a pose that is off by `offset_m` along x and known only to `sigma_m`.
struct TwoMaps {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  std::vector<core::LandmarkId> old, copies;

  TwoMaps(const std::vector<Eigen::Vector2d>& points_m, double offset_m, double sigma_m) {
    const Eigen::Matrix2d R = 1e-4 * Eigen::Matrix2d::Identity();
    for (const Eigen::Vector2d& p : points_m) old.push_back(filter.augment(core::make_cartesian(p, R), {}));
    core::Odometry odometry;
    odometry.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, 1e-10;
    filter.predict(odometry);
    for (const Eigen::Vector2d& p : points_m) {
      copies.push_back(filter.augment(core::make_cartesian(p + Eigen::Vector2d(offset_m, 0.0), R), {}));
    }
  }

  std::size_t found() const {
    const KeptRemoved pairs = leftovers(filter, copies, old, {});
    for (const auto& [kept, removed] : pairs) {
      EXPECT_EQ(kept - old.front(), removed - copies.front()) << "a copy went to another's original";
    }
    return pairs.size();
  }
};

std::vector<Eigen::Vector2d> row(int n, double pitch_m) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < n; ++i) points.emplace_back(5.0 + pitch_m * i, 0.0);
  return points;
}

TEST(Leftovers, AreCopiesWithinTheirReach) {
  EXPECT_EQ(TwoMaps(row(5, 4.6), 0.2, 0.2).found(), 5u);
  EXPECT_EQ(TwoMaps(row(5, 4.6), 1.5, 0.6).found(), 5u) << "within a third of the pitch";
  EXPECT_EQ(TwoMaps(row(5, 4.6), 1.8, 0.7).found(), 0u) << "beyond";
  EXPECT_EQ(TwoMaps(row(5, 2.5), 0.95, 0.32).found(), 5u) << "a metre, however dense the map is";
  EXPECT_EQ(TwoMaps(row(5, 2.0), 0.9, 0.3).found(), 0u) << "nine times likelier than a neighbour's is not enough";
}

TEST(Leftovers, AreNoneWhereTwoOldOnesAreCompatible) {
  EXPECT_EQ(TwoMaps(row(5, 4.6), 1.5, 1.2).found(), 0u) << "not the last of the row either, with no neighbour ahead";
  EXPECT_EQ(TwoMaps(row(5, 2.0), 0.2, 1.0).found(), 0u);
}

TEST(Leftovers, ReachFartherWhereOldOnesStandAlone) {
  EXPECT_EQ(TwoMaps(row(1, 0.0), 2.4, 1.0).found(), 1u);
  EXPECT_EQ(TwoMaps(row(1, 0.0), 2.6, 1.0).found(), 0u);
  EXPECT_EQ(TwoMaps(row(1, 0.0), 2.4, 0.5).found(), 0u) << "incompatible";
}

}  // namespace
}  // namespace helixnav::supervisor
