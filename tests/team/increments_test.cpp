// SPDX-License-Identifier: BSD-3-Clause
#include "increments.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

namespace helixnav::team {
namespace {

core::Odometry increment_to(core::Nanoseconds t_ns) {
  core::Odometry motion;
  motion.t_ns = t_ns;
  motion.T_before_after = {0.1 * static_cast<double>(t_ns), 0.0, 0.05};
  motion.covariance = Eigen::Vector3d(1e-4, 1e-5, 1e-5).asDiagonal();
  return motion;
}

/// All pieces, after what `order` does one after the other: to add the increment to a time, or (negative) to cut there.
std::vector<core::Odometry> pieces_after(const std::vector<core::Nanoseconds>& order) {
  Increments increments;
  std::vector<core::Odometry> pieces;
  for (const core::Nanoseconds what : order) {
    const core::Nanoseconds t_ns = std::abs(what);
    if (what > 0) {
      increments.add(increment_to(t_ns));
    } else if (!increments.cut(t_ns)) {
      continue;
    }
    const Increments::Pieces now = increments.pieces_about(t_ns);
    const auto is_replaced = [&](const core::Odometry& one) {
      return one.t_ns > now.after_ns && one.t_ns <= now.until_ns;
    };
    pieces.erase(std::remove_if(pieces.begin(), pieces.end(), is_replaced), pieces.end());
    pieces.insert(pieces.end(), now.motions.begin(), now.motions.end());
    std::stable_sort(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.t_ns < b.t_ns; });
  }
  return pieces;
}

TEST(Increments, AreCutAlikeInAnyOrderOfArrival) {
  const std::vector<core::Odometry> in_time = pieces_after({10, 20, -15, 30, -22, -28, 40});
  ASSERT_EQ(in_time.size(), 7u);
  for (const std::vector<core::Nanoseconds>& order : std::vector<std::vector<core::Nanoseconds>>{
           {10, 30, -15, 20, -28, -22, 40}, {40, -28, -15, -22, 30, 10, 20}, {30, 40, -22, 20, -28, -15, 10}}) {
    const std::vector<core::Odometry> pieces = pieces_after(order);
    ASSERT_EQ(pieces.size(), in_time.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      EXPECT_EQ(pieces[i].t_ns, in_time[i].t_ns);
      EXPECT_EQ(pieces[i].T_before_after.vector(), in_time[i].T_before_after.vector());
      EXPECT_EQ(pieces[i].covariance, in_time[i].covariance);
    }
  }
}

TEST(Increments, AreNotCutBeforeTheFirstNorAtTheirEnds) {
  Increments increments;
  EXPECT_FALSE(increments.cut(5));
  increments.add(increment_to(10));
  EXPECT_FALSE(increments.cut(10));
  EXPECT_EQ(increments.pieces_about(10).motions.size(), 1u);
}

}  // namespace
}  // namespace helixnav::team
