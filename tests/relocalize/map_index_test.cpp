// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/relocalize/map_index.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <set>

#include "helixnav/core/errors.hpp"
#include "worlds.hpp"

namespace helixnav::relocalize {
namespace {

constexpr double noise_m = 0.1;
constexpr IndexOptions index_options = {30.0, noise_m};

using Triple = std::array<core::LandmarkId, 3>;

/// The definition, landmark by landmark: pairs of the eight nearest within reach, sorted by distance, then id.
std::vector<Triple> brute_force(const std::vector<Landmark>& map) {
  std::set<Triple> found;
  for (const Landmark& centre : map) {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i = 0; i < map.size(); ++i) {
      const double d_m = (map[i].point.mean_m - centre.point.mean_m).norm();
      if (map[i].id != centre.id && d_m <= index_options.reach_m) near.emplace_back(d_m, i);
    }
    std::sort(near.begin(), near.end());
    near.resize(std::min<std::size_t>(near.size(), 8));
    for (std::size_t a = 0; a < near.size(); ++a)
      for (std::size_t b = a + 1; b < near.size(); ++b) {
        const Landmark& first = map[near[a].second];
        const Landmark& second = map[near[b].second];
        const Eigen::Vector2d u = first.point.mean_m - centre.point.mean_m;
        const Eigen::Vector2d v = second.point.mean_m - centre.point.mean_m;
        const double longest_m = std::max({u.norm(), v.norm(), (u - v).norm()});
        const double shortest_m = std::min({u.norm(), v.norm(), (u - v).norm()});
        const double height_m = std::abs(u.x() * v.y() - u.y() * v.x()) / longest_m;
        if (shortest_m < 6.0 * noise_m || height_m < 4.8 * noise_m) continue;
        Triple ids = {centre.id, first.id, second.id};
        std::sort(ids.begin(), ids.end());
        found.insert(ids);
      }
  }
  return {found.begin(), found.end()};
}

std::vector<Landmark> scattered(std::size_t count, std::uint64_t seed) {
  core::RandomStream random(seed);
  return test::landmarks(test::uniform_world(count, random), noise_m);
}

TEST(MapIndex, HoldsTheTrianglesThatTheDefinitionNames) {
  const auto map = scattered(300, 1);
  EXPECT_EQ(MapIndex(index_options, map).list_triangles(), brute_force(map));
}

TEST(MapIndex, IsTheSameWhetherBuiltAtOnceOrLandmarkByLandmark) {
  const auto map = scattered(1500, 2);
  MapIndex grown(index_options);
  for (const Landmark& landmark : map) grown.insert(landmark);
  EXPECT_EQ(grown.list_triangles(), MapIndex(index_options, map).list_triangles());
}

TEST(MapIndex, IsThatOfWhatIsLeftAfterAThousandInsertionsRemovalsAndMoves) {
  core::RandomStream random(3);
  auto map = scattered(250, 3);
  MapIndex index(index_options, map);
  core::LandmarkId next = 250;
  for (int step = 0; step < 1000; ++step) {
    const std::size_t at = random.below(map.size());
    const Eigen::Vector2d anywhere(random.uniform(0.0, 130.0), random.uniform(0.0, 130.0));
    switch (random.below(3)) {
      case 0:
        map.push_back(test::landmark(next++, anywhere, 0.07));
        index.insert(map.back());
        break;
      case 1:
        index.erase(map[at].id);
        map.erase(map.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      default:
        map[at].point.mean_m = step % 2 == 0 ? anywhere : Eigen::Vector2d(map[at].point.mean_m + 0.01 * anywhere);
        index.move(map[at]);
    }
  }
  EXPECT_EQ(index.size(), map.size());
  EXPECT_EQ(index.list_triangles(), brute_force(map));
}

TEST(MapIndex, IsCopiedWithAllThatItHolds) {
  const auto map = scattered(300, 2);
  MapIndex original(index_options, map);
  const MapIndex copy = original;
  for (const Landmark& landmark : map) original.erase(landmark.id);
  EXPECT_EQ(copy.list_triangles(), brute_force(map));
  EXPECT_TRUE(original.list_triangles().empty());
}

TEST(MapIndex, CanBeEmptiedAndFilledAgain) {
  const auto map = scattered(100, 4);
  MapIndex index(index_options, map);
  for (const Landmark& landmark : map) index.erase(landmark.id);
  EXPECT_EQ(index.size(), 0U);
  EXPECT_EQ(index.triangles(), 0U);
  for (const Landmark& landmark : map) index.insert(landmark);
  EXPECT_EQ(index.list_triangles(), brute_force(map));
}

TEST(MapIndex, BreaksTiesOfALatticeByIdAndNotByTheOrderOfInsertion) {
  core::RandomStream random(5);
  auto map = test::landmarks(test::orchard(400, false, 0.0, random), noise_m);
  const MapIndex forwards(index_options, map);
  std::reverse(map.begin(), map.end());
  MapIndex backwards(index_options);
  for (const Landmark& landmark : map) backwards.insert(landmark);
  EXPECT_EQ(forwards.list_triangles(), backwards.list_triangles());
}

TEST(MapIndex, CostsLessThanTwoHundredBytesALandmark) {
  for (const std::size_t count : {10000U, 40000U}) {
    core::RandomStream random(6);
    const MapIndex at_once = test::index_of(test::uniform_world(count, random), index_options);
    EXPECT_LT(at_once.memory_bytes(), 200U * count);
    MapIndex grown(index_options);
    for (const Landmark& landmark : scattered(count, 7)) grown.insert(landmark);
    grown.look_around_landmarks();
    EXPECT_LT(grown.memory_bytes(), 200U * count);
  }
}

TEST(MapIndex, MeasuresTheGroundThatWasLookedAtOnce) {
  MapIndex index(index_options);
  index.look_at({{100.0, 50.0}, 40.0});
  const double disc_m2 = core::pi * 1600.0;
  EXPECT_NEAR(index.looked_at_m2(), disc_m2, 0.02 * disc_m2);
  index.look_at({{100.0, 50.0}, 40.0});
  EXPECT_NEAR(index.looked_at_m2(), disc_m2, 0.02 * disc_m2);
}

TEST(MapIndex, RefusesWhatItCannotHoldAndStaysAsItWas) {
  EXPECT_THROW(MapIndex({30.0, 0.0}), core::PreconditionError);
  EXPECT_THROW(MapIndex({1.0, 0.1}), core::PreconditionError);
  EXPECT_THROW(MapIndex({std::numeric_limits<double>::quiet_NaN(), 0.1}), core::PreconditionError);
  auto map = scattered(50, 8);
  MapIndex index(index_options, map);
  const auto before = index.list_triangles();
  EXPECT_THROW(index.insert(map[3]), core::PreconditionError);
  EXPECT_THROW(index.erase(77), core::PreconditionError);
  EXPECT_THROW(index.erase(-1), core::PreconditionError);
  Landmark bad = test::landmark(60, {1.0, std::numeric_limits<double>::infinity()}, 0.1);
  EXPECT_THROW(index.insert(bad), core::PreconditionError);
  bad = test::landmark(60, {1e9, 0.0}, 0.1);
  EXPECT_THROW(index.insert(bad), core::PreconditionError);
  bad = test::landmark(60, {1.0, 1.0}, 0.1);
  bad.point.covariance_m2(0, 0) = -1.0;
  EXPECT_THROW(index.insert(bad), core::PreconditionError);
  bad = map[4];
  bad.size = Size{0.3, 0.0};
  EXPECT_THROW(index.move(bad), core::PreconditionError);
  EXPECT_THROW(index.look_at({{0.0, 0.0}, -1.0}), core::PreconditionError);
  map.push_back(map.front());
  EXPECT_THROW(MapIndex(index_options, map), core::PreconditionError);
  EXPECT_EQ(index.list_triangles(), before);
}

}  // namespace
}  // namespace helixnav::relocalize
