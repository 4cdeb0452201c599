// SPDX-License-Identifier: BSD-3-Clause
#include "movers.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "helixnav/sim/simulate.hpp"
#include "recordings.hpp"

namespace helixnav::sim {
namespace {

using testing::events_of;

Scenario walk_and_drive(double in_view) {
  Scenario scenario = named_scenario("movers");
  scenario.world.tour_m = 900.0;
  scenario.scanner.clutter_per_scan = 0.0;
  scenario.movers.in_view = in_view;
  return scenario;
}

double unlabelled_a_scan(const core::Recording& run) {
  double count = 0.0;
  for (const std::vector<core::Label>& scan : run.labels) {
    count += static_cast<double>(std::count(scan.begin(), scan.end(), core::no_label));
  }
  return count / static_cast<double>(run.labels.size());
}

/// The last one drawn may exceed the mean by its own time in view, up to a minute out of five; detected like trees.
TEST(Movers, SoManyAreInViewOnTheMeanAndNoneIsATree) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const double detected = named_scenario("movers").scanner.detection_probability;
    EXPECT_NEAR(unlabelled_a_scan(simulate(walk_and_drive(2.0), seed)), 2.0 * detected, 0.45) << seed;
    EXPECT_EQ(unlabelled_a_scan(simulate(walk_and_drive(0.0), seed)), 0.0);
  }
}

TEST(Movers, LeaveWhatIsSeenOfTheTreesAndTheOdometryAsTheyWere) {
  const core::Recording with = simulate(walk_and_drive(2.0), 4);
  const core::Recording without = simulate(walk_and_drive(0.0), 4);
  EXPECT_EQ(testing::odometry_bytes(with), testing::odometry_bytes(without));
  EXPECT_EQ(testing::truth_bytes(with), testing::truth_bytes(without));
  const auto a = events_of<core::Scan>(with);
  const auto b = events_of<core::Scan>(without);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::vector<std::pair<core::Label, double>> trees_a, trees_b;
    for (std::size_t j = 0; j < a[i].observations.size(); ++j) {
      if (with.labels[i][j] != core::no_label) trees_a.emplace_back(with.labels[i][j], a[i].observations[j].z[0]);
    }
    for (std::size_t j = 0; j < b[i].observations.size(); ++j) {
      trees_b.emplace_back(without.labels[i][j], b[i].observations[j].z[0]);
    }
    std::sort(trees_a.begin(), trees_a.end());
    std::sort(trees_b.begin(), trees_b.end());
    EXPECT_EQ(trees_a, trees_b) << i;
  }
}

TEST(Movers, AreNamedAsAClassLikeTrees) {
  Scenario scenario = walk_and_drive(2.0);
  scenario.scanner.looks.classes = 4;
  const core::Recording run = simulate(scenario, 4);
  for (const core::Scan& scan : events_of<core::Scan>(run)) {
    for (const core::Observation& seen : scan.observations) ASSERT_FALSE(seen.appearance.name.empty());
  }
}

TEST(Movers, WalkAndDriveAtSpeedsOfTheirsOnEitherSideOfAStraightRoad) {
  Scenario scenario = walk_and_drive(1.0);
  scenario.movers.car_share = 0.0;
  const Route road({{0.0, 0.0}, {500.0, 0.0}});
  const std::vector<DriveStep> steps = drive(road, 400.0, scenario.vehicle);
  const Movers movers(scenario, road, steps, 5);
  const auto before = movers.at(60.0);
  const auto after = movers.at(61.0);
  ASSERT_EQ(before.size(), after.size());
  ASSERT_GE(before.size(), 3u);
  double least_y_m = 0.0;
  double most_y_m = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Eigen::Vector2d moved_m = after[i] - before[i];
    EXPECT_GE(moved_m.norm(), scenario.movers.walking_mps.min - 1e-9);
    EXPECT_LE(moved_m.norm(), scenario.movers.walking_mps.max + 1e-9);
    EXPECT_NEAR(moved_m.y(), 0.0, 1e-9);
    least_y_m = std::min(least_y_m, before[i].y());
    most_y_m = std::max(most_y_m, before[i].y());
  }
  EXPECT_LE(least_y_m, -2.0);
  EXPECT_GE(most_y_m, 2.0);
}

TEST(Forest, HasTheDensityAndTheTwinsOfARealOneAndEightyStemsAScan) {
  const Scenario scenario = named_scenario("forest");
  const World world = build_world(scenario.world, 6);
  const core::Recording run = simulate_in(world, scenario, 6);
  double observations = 0.0;
  for (const std::vector<core::Label>& scan : run.labels) observations += static_cast<double>(scan.size());
  EXPECT_NEAR(observations / static_cast<double>(run.labels.size()), 80.0, 20.0);
  std::size_t twins = 0;
  for (std::size_t i = 1; i < world.trees.size(); ++i) {
    const double apart_m = (world.trees[i].point_m - world.trees[i - 1].point_m).norm();
    if (apart_m >= nearest_trees_m) continue;
    EXPECT_GE(apart_m, scenario.world.twin_m.min);
    EXPECT_LE(apart_m, scenario.world.twin_m.max);
    ++twins;
  }
  const double share = static_cast<double>(twins) / static_cast<double>(world.trees.size() - twins);
  EXPECT_NEAR(share, scenario.world.twin_share, 0.035) << "about 700 trees: four standard deviations";
}

}  // namespace
}  // namespace helixnav::sim
