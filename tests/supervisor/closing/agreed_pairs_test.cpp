// SPDX-License-Identifier: BSD-3-Clause
#include "closing/agreed_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace helixnav::supervisor {
namespace {

using Pairs = std::vector<pf_relocalize::ConstellationPair>;
using Points = std::vector<Eigen::Vector2d>;

const Points clump{{7.0, -1.0}, {7.9, -0.6}, {7.3, 0.1}, {8.4, -1.3}};

Points posts(int count) {
  Points points;
  for (int i = 0; i < count; ++i) points.emplace_back(8.0 + 0.5 * i, -4.0);
  return points;
}

/// Old landmarks, then the loss of the place by 3 m and 6°, then some of them again as a branch.
struct MappedAgain {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  SearchOptions options;
  std::vector<core::LandmarkId> old;
  Branch branch;

  explicit MappedAgain(const Points& points, std::size_t from = 0, std::size_t to = 1000) {
    for (const Eigen::Vector2d& point_m : points) old.push_back(see(point_m));
    core::Odometry drift;
    drift.covariance.diagonal() << 9.0, 9.0, 0.01;
    filter.predict(drift);
    for (std::size_t i = from; i < std::min(to, points.size()); ++i) branch.confirmed.push_back(see(points[i]));
  }

  core::LandmarkId see(const Eigen::Vector2d& point_m) {
    return filter.augment(core::make_cartesian(point_m, 0.01 * Eigen::Matrix2d::Identity()), {});
  }

  /// Of the k-th branch landmark with the k-th old one, `by` further on; as many as there are of both.
  Pairs shifted(std::size_t count, std::size_t by) const {
    Pairs pairs;
    for (std::size_t i = 0; i < count; ++i) pairs.push_back({branch.confirmed[i], old[i + by], 0.1});
    return pairs;
  }

  Pairs agreed(const Pairs& pairs) const { return agreed_pairs(filter, branch, old, pairs, options); }

  std::size_t right(const Pairs& pairs, std::size_t from = 0) const {
    return static_cast<std::size_t>(std::count_if(pairs.begin(), pairs.end(), [&](const auto& pair) {
      const auto at = std::find(branch.confirmed.begin(), branch.confirmed.end(), pair.branch);
      return pair.old_landmark == old[from + static_cast<std::size_t>(at - branch.confirmed.begin())];
    }));
  }
};

TEST(AgreedPairs, AreThoseGivenWhereNothingStandsNear) {
  const MappedAgain apart({{5.0, 0.0}, {12.0, 3.0}, {9.0, -6.0}, {17.0, 8.0}, {20.0, -3.0}});
  const Pairs given = apart.shifted(5, 0);
  const Pairs agreed = apart.agreed(given);
  ASSERT_EQ(agreed.size(), given.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    EXPECT_EQ(agreed[i].branch, given[i].branch);
    EXPECT_EQ(agreed[i].old_landmark, given[i].old_landmark);
  }
  EXPECT_EQ(apart.agreed(apart.shifted(2, 0)).size(), 2U) << "too few to be a place";
}

TEST(AgreedPairs, AreOfTheWayThatExplainsMore) {
  Points points = posts(10);
  points.insert(points.end(), clump.begin(), clump.end());
  const MappedAgain fence(points);
  const Pairs one_post_on = fence.shifted(9, 1);
  const Pairs agreed = fence.agreed(one_post_on);
  EXPECT_EQ(agreed.size(), 14U);
  EXPECT_EQ(fence.right(agreed), 14U);
}

/// The branch has seen four posts of ten, and none beside them.
TEST(AgreedPairs, AreNoneWhereTwoWaysFit) {
  const MappedAgain fence(posts(10), 3, 7);
  EXPECT_TRUE(fence.agreed(fence.shifted(4, 3)).empty());
}

/// An undecided search has left the same ten trees on the map twice, half a metre apart: either copy is right.
TEST(AgreedPairs, AreThoseOfOneCopyWhereTheMapHasTwo) {
  Points points = posts(1);
  points.insert(points.end(), clump.begin(), clump.end());
  const std::size_t once = points.size();
  for (std::size_t i = 0; i < once; ++i) points.push_back(points[i] + Eigen::Vector2d(0.3, -0.35));
  const MappedAgain twice(points, 0, once);
  const Pairs agreed = twice.agreed(twice.shifted(once, 0));
  ASSERT_EQ(agreed.size(), once);
  EXPECT_TRUE(twice.right(agreed) == once || twice.right(agreed, once) == once);
}

/// Tolerances let neighbours pass: the pairs of two stems are swapped.
TEST(AgreedPairs, LeaveOutOrMendWhatIsMixedUp) {
  Points points{{6.0, 0.0}, {6.35, 0.2}, {12.0, 3.0}, {9.0, -6.0}, {17.0, 8.0}, {20.0, -3.0}};
  const MappedAgain twins(points);
  Pairs given = twins.shifted(6, 0);
  std::swap(given[0].old_landmark, given[1].old_landmark);
  const Pairs agreed = twins.agreed(given);
  EXPECT_GE(agreed.size(), 4U);
  EXPECT_EQ(twins.right(agreed), agreed.size());
}

}  // namespace
}  // namespace helixnav::supervisor
