// SPDX-License-Identifier: BSD-3-Clause
#include "closing/tied_pairs.hpp"

#include <gtest/gtest.h>

namespace helixnav::supervisor {
namespace {

using Pairs = std::vector<pf_relocalize::ConstellationPair>;

/// Rows of trees 4 m apart: an older layer of `first`, a later one of `second`, and a branch that pairs with both.
/// Between the layers, the position becomes uncertain by sigma_m in each direction.
struct TwoLayers {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  Pairs pairs;

  TwoLayers(int first, int second, double sigma_m) {
    std::vector<core::LandmarkId> old;
    for (int i = 0; i < first; ++i) old.push_back(see(i));
    lose(sigma_m);
    for (int i = 0; i < second; ++i) old.push_back(see(first + i));
    lose(20.0);
    for (std::size_t i = 0; i < old.size(); ++i) pairs.push_back({see(static_cast<int>(i)), old[i], 0.1});
  }

  core::LandmarkId see(int i) {
    const Eigen::Vector2d point_m(5.0 + 4.0 * (i % 8), 4.0 * (i / 8));
    return filter.augment(core::make_cartesian(point_m, 0.01 * Eigen::Matrix2d::Identity()), {});
  }

  void lose(double sigma_m) {
    core::Odometry odometry;
    odometry.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, 1e-8;
    filter.predict(odometry);
  }

  std::size_t tied() const { return tied_pairs(filter, pairs).size(); }
};

TEST(TiedPairs, AreAllOfAMapInOnePiece) {
  EXPECT_EQ(TwoLayers(20, 4, 0.3).tied(), 24U);
  EXPECT_EQ(TwoLayers(1, 0, 0.0).tied(), 1U);
  EXPECT_TRUE(tied_pairs(cekf::CompressedEkf(core::PoseGaussian{}), {}).empty());
}

TEST(TiedPairs, AreNoFewOfAPieceThatTheyAloneWouldFix) {
  const TwoLayers few(20, 4, 10.0);
  const Pairs tied = tied_pairs(few.filter, few.pairs);
  ASSERT_EQ(tied.size(), 20U);
  for (std::size_t i = 0; i < tied.size(); ++i) EXPECT_EQ(tied[i].branch, few.pairs[i].branch);
  EXPECT_EQ(TwoLayers(4, 20, 10.0).tied(), 20U) << "the older ones";
}

TEST(TiedPairs, AreThoseOfTwoPiecesWhereBothHaveMany) { EXPECT_EQ(TwoLayers(20, 10, 10.0).tied(), 30U); }

// Each is known to 0.6 m relative to the next, the last to 2.6 m relative to the first.
TEST(TiedPairs, AreAllOfAChain) {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  std::vector<core::LandmarkId> old;
  const auto see = [&](double x_m) {
    return filter.augment(core::make_cartesian({x_m, 0.0}, 0.01 * Eigen::Matrix2d::Identity()), {});
  };
  core::Odometry drift;
  drift.covariance.diagonal() << 0.36, 0.01, 1e-8;
  for (int i = 0; i < 20; ++i) {
    old.push_back(see(5.0 + 4.0 * i));
    filter.predict(drift);
  }
  Pairs pairs;
  for (int i = 0; i < 20; ++i) pairs.push_back({see(5.0 + 4.0 * i), old[static_cast<std::size_t>(i)], 0.1});
  EXPECT_EQ(tied_pairs(filter, pairs).size(), 20U);
}

}  // namespace
}  // namespace helixnav::supervisor
