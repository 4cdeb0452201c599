// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/route.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::sim {
namespace {

Route corner() { return Route({{0.0, 0.0}, {10.0, 0.0}, {10.0, 5.0}}); }

TEST(Route, IsParametrisedByTheDistanceAlong) {
  const Route route = corner();
  EXPECT_DOUBLE_EQ(route.length_m(), 15.0);
  EXPECT_EQ(route.at(4.0), Eigen::Vector2d(4.0, 0.0));
  EXPECT_EQ(route.at(10.0), Eigen::Vector2d(10.0, 0.0));
  EXPECT_EQ(route.at(12.0), Eigen::Vector2d(10.0, 2.0));
}

TEST(Route, EndsAtItsEnds) {
  EXPECT_EQ(corner().at(-1.0), Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(corner().at(99.0), Eigen::Vector2d(10.0, 5.0));
}

TEST(Route, DirectionIsAUnitVectorOfTravel) {
  EXPECT_EQ(corner().direction(5.0), Eigen::Vector2d(1.0, 0.0));
  EXPECT_EQ(corner().direction(15.0), Eigen::Vector2d(0.0, 1.0));
  EXPECT_LT((corner().direction(10.0) - Eigen::Vector2d(1.0, 1.0).normalized()).norm(), 1e-12);
}

TEST(Route, NearestPointIsSoughtOnTheStretchOnly) {
  const Route route = corner();
  EXPECT_NEAR(route.nearest_along_m({3.0, 2.0}, {0.0, 15.0}), 3.0, 1e-12);
  EXPECT_NEAR(route.nearest_along_m({3.0, 2.0}, {5.0, 15.0}), 5.0, 1e-12);
  EXPECT_NEAR(route.nearest_along_m({12.0, 3.0}, {0.0, 15.0}), 13.0, 1e-12);
  EXPECT_NEAR(route.distance_m({12.0, 3.0}), 2.0, 1e-12);
  EXPECT_NEAR(route.distance_m({-3.0, -4.0}), 5.0, 1e-12);
}

/// Segments are skipped 64 at a time if they are farther away than the nearest so far.
TEST(Route, NearestPointOfALongRouteIsThatOfAllItsSegments) {
  core::RandomStream random(5, "route_test");
  std::vector<Eigen::Vector2d> points_m{{0.0, 0.0}};
  double heading_rad = 0.0;
  for (int i = 0; i < 1000; ++i) {
    heading_rad += random.normal(0.0, 0.2);
    points_m.emplace_back(points_m.back() + 0.5 * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad)));
  }
  const Route route(points_m);
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector2d point_m =
        points_m[random.below(points_m.size())] + Eigen::Vector2d(random.normal(0.0, 20.0), random.normal(0.0, 20.0));
    double nearest_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < points_m.size(); ++i) {
      const Eigen::Vector2d way_m = points_m[i + 1] - points_m[i];
      const double share = std::clamp((point_m - points_m[i]).dot(way_m) / way_m.squaredNorm(), 0.0, 1.0);
      nearest_m = std::min(nearest_m, (points_m[i] + share * way_m - point_m).norm());
    }
    EXPECT_NEAR(route.distance_m(point_m), nearest_m, 1e-9);
  }
}

TEST(Route, FromOriginStartsAtTheOriginAlongX) {
  const Route route = route_from_origin({{5.0, 5.0}, {5.0, 8.0}, {9.0, 8.0}});
  EXPECT_LT(route.at(0.0).norm(), 1e-12);
  EXPECT_LT((route.at(3.0) - Eigen::Vector2d(3.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((route.at(7.0) - Eigen::Vector2d(3.0, -4.0)).norm(), 1e-12);
}

TEST(Route, RefusesWhatIsNoPolyline) {
  EXPECT_THROW(Route({{0.0, 0.0}}), core::PreconditionError);
  EXPECT_THROW(Route({{0.0, 0.0}, {0.0, 0.0}}), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::sim
