// SPDX-License-Identifier: BSD-3-Clause
#include "lineages.hpp"

#include <set>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::fastslam {
namespace {

/// Distance of a point from a rectangle.
double beside_m(const Eigen::Vector2d& p, const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  return (p - p.cwiseMax(low).cwiseMin(high)).norm();
}

TEST(Lineages, FindExactlyWhoseReachMeetsARectangle) {
  core::RandomStream random(1, "lineages");
  Lineages lineages;
  std::vector<bool> alive;
  for (int k = 0; k < 3000; ++k) {
    const LineageId id = lineages.add({random.uniform(-150.0, 150.0), random.uniform(-90.0, 90.0)});
    alive.push_back(true);
    if (random.bernoulli(0.3)) lineages.grow(id, Lineages::reach_for(random.uniform(0.0, 9.0)));
    if (k % 1000 == 999) {
      for (std::size_t dead = 0; dead < alive.size(); dead += 3) alive[dead] = false;
      lineages.sweep(alive);
    }
  }
  std::size_t found_in_all = 0;
  for (int look = 0; look < 300; ++look) {
    const Eigen::Vector2d low(random.uniform(-170.0, 170.0), random.uniform(-100.0, 100.0));
    const Eigen::Vector2d high = low + Eigen::Vector2d(random.uniform(0.0, 30.0), random.uniform(0.0, 30.0));
    const double margin_m = random.uniform(0.0, 10.0);
    std::multiset<LineageId> found;
    lineages.visit(low, high, margin_m, [&](LineageId id) { found.insert(id); });
    std::multiset<LineageId> expected;
    for (LineageId id = 0; id < lineages.size(); ++id) {
      if (!alive[id]) continue;
      if (beside_m(lineages.anchor_m(id), low, high) <= margin_m + lineages.reach_m(id)) expected.insert(id);
    }
    EXPECT_EQ(found, expected);
    found_in_all += found.size();
  }
  EXPECT_GT(found_in_all, 1000U);
}

TEST(Lineages, ReachCoversTheDistanceAndTakesFewValues) {
  std::set<float> values;
  for (double d = 0.0; d < 20.0; d += 0.001) {
    EXPECT_GE(Lineages::reach_for(d), d);
    values.insert(Lineages::reach_for(d));
  }
  EXPECT_LT(values.size(), 25U);
}

}  // namespace
}  // namespace helixnav::fastslam
