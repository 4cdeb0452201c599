// SPDX-License-Identifier: BSD-3-Clause
#include "placing/session_leftovers.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "bent_avenue.hpp"
#include "helixnav/supervisor/join_sessions.hpp"

namespace helixnav::supervisor {
namespace {

struct JudgedJoin {
  int shared = 0;  ///< trees that both maps have
  int twice = 0;   ///< of those, left twice
  int wrong = 0;   ///< different trees that became one

  JudgedJoin& operator+=(const JudgedJoin& other) {
    shared += other.shared;
    twice += other.twice;
    wrong += other.wrong;
    return *this;
  }
};

JudgedJoin judged(const JoinedSessions& joined) {
  JudgedJoin judged;
  if (joined.components.size() != 1) return judged;
  for (const auto& [own, name] : joined.sessions[1].name_of) {
    for (const auto& [other, same] : joined.sessions[0].name_of) {
      judged.shared += own == other ? 1 : 0;
      judged.twice += own == other && name != same ? 1 : 0;
      judged.wrong += own != other && name == same ? 1 : 0;
    }
  }
  return judged;
}

/// The later drive turned round between two trees of the avenue, so that neither of its ends tells one place from the next.
std::vector<core::JointMap> two_drives(const BentAvenue& avenue, std::uint64_t seed) {
  return {avenue.drive(0.0, 2.0 * avenue.avenue_until_m, 10 * seed + 1), avenue.drive(200.0, 330.0, 10 * seed + 2)};
}

std::vector<Eigen::Vector2d> sorted_points(const JoinedSessions& joined) {
  std::vector<Eigen::Vector2d> points_m = joined.components.at(0).joint.points_m;
  std::sort(points_m.begin(), points_m.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  return points_m;
}

/// Without segments 143 of 443 trees stay twice.
TEST(SessionLeftovers, AreMergedAsSegmentsWhereOneTreeMayBeSeveral) {
  JudgedJoin all;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    all += judged(join_sessions(two_drives(BentAvenue(1000 + seed, 3.0), seed)));
  }
  EXPECT_GE(all.shared, 400);
  EXPECT_EQ(all.wrong, 0);
  EXPECT_LE(all.twice, 50);
}

/// Also of maps whose covariance is a quarter of what it should be, which then favours some place or other.
TEST(SessionLeftovers, StayWhereAnAvenueRepeatsItself) {
  JudgedJoin all;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    BentAvenue avenue(1000 + seed, 0.0);
    for (const double claimed : {1.0, 0.5}) {
      avenue.claimed = claimed;
      all += judged(join_sessions(two_drives(avenue, seed)));
    }
  }
  EXPECT_GE(all.twice, 20);
  EXPECT_EQ(all.wrong, 0);
}

TEST(SessionLeftovers, AreTheSameInAnyOrder) {
  const std::vector<core::JointMap> maps = two_drives(BentAvenue(1005, 3.0), 5);
  const JoinedSessions joined = join_sessions(maps);
  const JoinedSessions swapped = join_sessions({maps[1], maps[0]});
  ASSERT_EQ(joined.components.size(), 1u);
  ASSERT_EQ(swapped.components.size(), 1u);
  const auto expected_m = sorted_points(joined), found_m = sorted_points(swapped);
  ASSERT_EQ(found_m.size(), expected_m.size());
  for (std::size_t i = 0; i < found_m.size(); ++i) EXPECT_LT((found_m[i] - expected_m[i]).norm(), 1e-6);
}

}  // namespace
}  // namespace helixnav::supervisor
