// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "helixnav/sim/scenario.hpp"

namespace helixnav::sim {
namespace {

constexpr double for_ever = std::numeric_limits<double>::infinity();

World world_of(const std::string& scenario, std::uint64_t seed) {
  return build_world(named_scenario(scenario).world, seed);
}

double nearest_neighbour_m(const World& world, std::size_t i) {
  double nearest_m = for_ever;
  for (std::size_t j = 0; j < world.trees.size(); ++j) {
    if (j != i) nearest_m = std::min(nearest_m, (world.trees[i].point_m - world.trees[j].point_m).norm());
  }
  return nearest_m;
}

TEST(World, NoTwoTreesAreNearerThanTwoMetresAndNoneStandsOnTheRoad) {
  for (const std::string& name : scenario_names()) {
    WorldOptions options = named_scenario(name).world;
    options.twin_share = 0.0;
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      const World world = build_world(options, seed);
      for (std::size_t i = 0; i < world.trees.size(); ++i) {
        ASSERT_GE(nearest_neighbour_m(world, i), nearest_trees_m) << name << " " << seed;
        ASSERT_GE(world.route.distance_m(world.trees[i].point_m), options.road_clearance_m) << name << " " << seed;
      }
    }
  }
}

TEST(World, LoopsCloseWhereTheySayAndAreAsLongAsDrawn) {
  for (const std::string name : {"large-loop", "two-laps", "orchard", "circuit", "long"}) {
    const WorldOptions options = named_scenario(name).world;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      const World world = build_world(options, seed);
      ASSERT_EQ(world.returns_at_m.size(), static_cast<std::size_t>(options.returns));
      for (const double return_m : world.returns_at_m) EXPECT_LT(world.route.at(return_m).norm(), 0.5) << name;
      EXPECT_GE(world.returns_at_m.front(), options.loop_length_m.min);
      EXPECT_LE(world.returns_at_m.front(), options.loop_length_m.max);
      EXPECT_NEAR(world.drive_m, world.returns_at_m.back() + options.drive_on_m, 1e-9);
      EXPECT_GT(world.route.length_m(), world.drive_m + 10.0);  // room to look ahead
    }
  }
}

TEST(World, LargeLoopDrivesOnMappedGroundForAtLeast150Metres) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const World world = world_of("large-loop", seed);
    const double first_tree_free_m = world.returns_at_m[0] - named_scenario("large-loop").world.bare_length_m.max;
    EXPECT_GE(world.drive_m - world.returns_at_m[0], 150.0);
    EXPECT_GE(first_tree_free_m, 150.0);
  }
}

TEST(World, LargeLoopIsBareBeforeItCloses) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const World world = world_of("large-loop", seed);
    const double lap_m = world.returns_at_m[0];
    for (const Tree& tree : world.trees) {
      const double along_m = world.route.nearest_along_m(tree.point_m, {0.0, lap_m});
      EXPECT_FALSE(along_m > lap_m - 200.0 && along_m < lap_m - 5.0) << seed << " " << along_m;
    }
  }
}

TEST(World, TreesOfTheLargeLoopHaveTheirNearestNeighbourAboutEightMetresAway) {
  std::vector<double> nearest_m;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const World world = world_of("large-loop", seed);
    for (std::size_t i = 0; i < world.trees.size(); ++i) nearest_m.push_back(nearest_neighbour_m(world, i));
  }
  std::nth_element(nearest_m.begin(), nearest_m.begin() + static_cast<long>(nearest_m.size() / 2), nearest_m.end());
  EXPECT_NEAR(nearest_m[nearest_m.size() / 2], 8.0, 0.7);
}

TEST(World, ChangingTreesLeavesTheRoadAndTheFirstLapAlone) {
  const World same = world_of("large-loop", 3);
  const World changed = world_of("large-loop-changed", 3);
  EXPECT_EQ(same.route.length_m(), changed.route.length_m());
  ASSERT_LE(same.trees.size(), changed.trees.size());
  for (std::size_t i = 0; i < same.trees.size(); ++i) {
    EXPECT_EQ(same.trees[i].point_m, changed.trees[i].point_m);
    EXPECT_EQ(changed.trees[i].present.from_m, 0.0);
    EXPECT_EQ(same.trees[i].present.to_m, for_ever);
  }
}

/// Shares of trees felled, and of new ones among those present at the return, where the vehicle comes again. The
/// first is binomial; the band is five sigma, false alarm 6e-7.
TEST(World, TheStatedShareOfTreesChanges) {
  int stood = 0, felled = 0, planted = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const World world = world_of("large-loop-changed", seed);
    for (const Tree& tree : world.trees) {
      const bool is_new = tree.present.from_m > 0.0;
      if (is_new) {
        ++planted;
        EXPECT_LT(tree.present.from_m, world.returns_at_m[0] - 34.0);  // before it could be seen to appear
      } else {
        ++stood;
        felled += tree.present.to_m < for_ever ? 1 : 0;
      }
    }
  }
  EXPECT_NEAR(felled, 0.3 * stood, 5.0 * std::sqrt(0.21 * stood));
  EXPECT_GT(planted, felled / 4);  // only where the vehicle drives again
  EXPECT_LT(planted, felled);
}

TEST(World, OpenRoadStaysOutOfSightOfItsOldTrees) {
  constexpr double farthest_seen_m = 30.0 + 3.9;  // range and lever arm of the scanner
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const World world = world_of("open-road", seed);
    EXPECT_TRUE(world.returns_at_m.empty());
    const double second_half_m = world.drive_m - 190.0;
    std::size_t old_trees = 0;
    for (const Tree& tree : world.trees) {
      if (world.route.nearest_along_m(tree.point_m, {0.0, world.drive_m}) > second_half_m) continue;
      ++old_trees;
      const double again_m = world.route.nearest_along_m(tree.point_m, {second_half_m, world.drive_m});
      EXPECT_GT((world.route.at(again_m) - tree.point_m).norm(), farthest_seen_m) << seed;
    }
    EXPECT_GT(old_trees, 20U);
  }
}

TEST(World, OrchardsDifferInPitchAndShape) {
  std::vector<double> pitches_m;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const World world = world_of("orchard", seed);
    pitches_m.push_back(nearest_neighbour_m(world, 0));
    EXPECT_GT(world.trees.size(), 80U);
  }
  const auto [smallest, largest] = std::minmax_element(pitches_m.begin(), pitches_m.end());
  EXPECT_GT(*smallest, 3.7);
  EXPECT_GT(*largest - *smallest, 1.5);
}

TEST(World, FigureOfEightComesBackToTwoRegionsThatAreFarApartAndToTheFirstOnceMore) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const World world = world_of("figure-of-eight", seed);
    ASSERT_EQ(world.returns_at_m.size(), 3U);
    EXPECT_GT((world.route.at(world.returns_at_m[0]) - world.route.at(world.returns_at_m[1])).norm(), 30.0);
    EXPECT_LT((world.route.at(world.returns_at_m[0]) - world.route.at(world.returns_at_m[2])).norm(), 1e-6);
  }
}

/// The end of a drive must not be where old ground comes into view again for which no return is defined.
TEST(World, FigureOfEightEndsOutOfSightOfTheNextReturn) {
  const double sight_m = sim::named_scenario("figure-of-eight").scanner.field_of_view.max_range_m;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const World world = world_of("figure-of-eight", seed);
    const Eigen::Vector2d end_m = world.route.at(world.drive_m);
    double nearest_m = for_ever;
    for (double along_m = world.returns_at_m[1]; along_m < world.returns_at_m[2] - 60.0; along_m += 1.0) {
      nearest_m = std::min(nearest_m, (world.route.at(along_m) - end_m).norm());
    }
    EXPECT_GT(nearest_m, sight_m) << seed;
    EXPECT_GT(world.drive_m - world.returns_at_m[2], 110.0) << "enough to close it";
  }
}

TEST(World, CircuitHasItsLandmarks) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) EXPECT_EQ(world_of("circuit", seed).trees.size(), 20U);
}

}  // namespace
}  // namespace helixnav::sim
