// SPDX-License-Identifier: BSD-3-Clause
#include "town.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "helixnav/core/odometry.hpp"
#include "helixnav/sim/scenario.hpp"
#include "helixnav/sim/simulate.hpp"

namespace helixnav::sim {
namespace {

bool is_on_a_street(const Eigen::Vector2d& point_m, double side_m, double margin_m) {
  const auto off_m = [&](double value_m) { return std::abs(value_m - side_m * std::round(value_m / side_m)); };
  return std::min(off_m(point_m.x()), off_m(point_m.y())) < margin_m;
}

TEST(Town, HasItsRoadOnStreetsAndItsTreesBesideThem) {
  const WorldOptions options = named_scenario("town").world;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const World world = build_world(options, seed);
    EXPECT_GT(world.route.length_m(), options.tour_m);
    for (double along_m = 0.0; along_m < options.tour_m; along_m += 5.0) {
      EXPECT_TRUE(is_on_a_street(world.route.at(along_m), options.block_side_m, 3.0)) << seed << " at " << along_m;
    }
    EXPECT_GT(world.trees.size(), 500u) << seed;
    for (const Tree& tree : world.trees) {
      EXPECT_TRUE(is_on_a_street(tree.point_m, options.block_side_m, options.tree_offset_m.max + 0.1)) << seed;
    }
  }
}

TEST(Town, ReturnsToTreesThatItHasPassed) {
  const World world = build_world(named_scenario("town").world, 4);
  ASSERT_FALSE(world.returns_at_m.empty());
  EXPECT_TRUE(std::is_sorted(world.returns_at_m.begin(), world.returns_at_m.end()));
  for (const double return_m : world.returns_at_m) {
    const Eigen::Vector2d middle_m = world.route.at(return_m + 60.0);
    const double before_m = world.route.nearest_along_m(middle_m, {0.0, return_m - 60.0});
    EXPECT_LT((world.route.at(before_m) - middle_m).norm(), 5.0) << "was here before";
  }
}

TEST(Town, HasStreetsWithoutTrees) {
  WorldOptions options = named_scenario("town").world;
  const auto trees = [&](double share) {
    options.bare_share = share;
    return build_world(options, 5).trees.size();
  };
  EXPECT_GT(static_cast<double>(trees(0.0)), 1.3 * static_cast<double>(trees(0.5)));
  EXPECT_GT(trees(1.0), 0u) << "the first street is never bare";
}

core::Pose2 true_increment(const core::Recording& run, std::size_t scan) {
  return core::between(run.true_poses[scan - 1].T_world_robot, run.true_poses[scan].T_world_robot);
}

TEST(Slips, AreInTheTruthAndNotInTheOdometry) {
  Scenario scenario = named_scenario("slip");
  scenario.true_noise.odometry = {0.0, 0.0};
  scenario.slip.turn_rad = {0.02, 0.08};
  const core::Recording run = simulate(scenario, 6);
  EXPECT_GE(run.true_slips_ns.size(), 10u);  // 24 on average: P < 0.001
  EXPECT_LE(run.true_slips_ns.size(), 42u);
  core::Odometry measured = core::no_motion(0);
  std::size_t scan = 0;
  std::size_t slips = 0;
  int since_scan = 0;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      measured = core::chain(measured, *odometry);
      for (; slips < run.true_slips_ns.size() && run.true_slips_ns[slips] == odometry->t_ns; ++slips) ++since_scan;
      continue;
    }
    if (scan > 0) {
      const core::Pose2 unmeasured = core::between(measured.T_before_after, true_increment(run, scan));
      if (since_scan == 0) {
        EXPECT_LT(unmeasured.vector().norm(), 1e-9) << scan;
      } else if (since_scan == 1) {
        EXPECT_GT(unmeasured.position_m().norm(), 0.2) << scan;
        EXPECT_LT(unmeasured.position_m().norm(), 1.0) << scan;
        EXPECT_GT(std::abs(unmeasured.heading_rad), 0.0199) << scan;
        EXPECT_LT(std::abs(unmeasured.heading_rad), 0.0801) << scan;
      }
    }
    ++scan;
    since_scan = 0;
    measured = core::no_motion(0);
  }
  EXPECT_EQ(slips, run.true_slips_ns.size());
}

TEST(Slips, LeaveTruthAndScansAsTheyWere) {
  const core::Recording with = simulate(named_scenario("slip"), 7);
  const core::Recording without = simulate(named_scenario("town"), 7);
  ASSERT_EQ(with.true_poses.size(), without.true_poses.size());
  EXPECT_EQ(with.labels, without.labels);
  EXPECT_EQ(with.true_poses.back().T_world_robot.vector(), without.true_poses.back().T_world_robot.vector());
  EXPECT_TRUE(without.true_slips_ns.empty());
}

TEST(Carried, LeavesOutStretchesOfTheDriveAndTheTimeThatTheyTook) {
  const Scenario scenario = named_scenario("kidnapped");
  const core::Recording run = simulate(scenario, 7);
  const double between_scans_m = scenario.vehicle.speed_mps * scenario.vehicle.odometry_period_s * 5;
  std::vector<double> pauses_s;
  core::Nanoseconds last_ns = 0;
  for (const core::Event& event : run.events) {
    const auto* odometry = std::get_if<core::Odometry>(&event);
    if (odometry == nullptr) continue;
    const double pause_s = core::seconds(odometry->t_ns - last_ns);
    if (pause_s > 1.5 * scenario.vehicle.odometry_period_s) pauses_s.push_back(pause_s);
    EXPECT_LT(odometry->T_before_after.position_m().norm(), between_scans_m) << "nobody measures it";
    last_ns = odometry->t_ns;
  }
  ASSERT_EQ(pauses_s.size(), 2u) << "3.6 km, every 1.4 km";
  for (const double pause_s : pauses_s) {
    EXPECT_GE(scenario.vehicle.speed_mps * pause_s, 95.0);
    EXPECT_LE(scenario.vehicle.speed_mps * pause_s, 410.0);
  }
}

TEST(Carried, IsSaidWhereTheScenarioSaysSoAndNothingElseChanges) {
  Scenario scenario = named_scenario("kidnapped");
  const core::Recording silent = simulate(scenario, 7);
  scenario.carried.announced = true;
  core::Recording told = simulate(scenario, 7);
  const auto is_lost = [](const core::Event& event) { return std::holds_alternative<core::Lost>(event); };
  EXPECT_EQ(std::count_if(told.events.begin(), told.events.end(), is_lost), 2);
  told.events.erase(std::remove_if(told.events.begin(), told.events.end(), is_lost), told.events.end());
  ASSERT_EQ(told.events.size(), silent.events.size());
  for (std::size_t i = 0; i < told.events.size(); ++i) {
    EXPECT_EQ(core::time_of(told.events[i]), core::time_of(silent.events[i]));
  }
  EXPECT_EQ(told.labels, silent.labels);
}

TEST(ScaledNoise, TakesOdometryAndDetectorApart) {
  const NoiseLevels noise = named_scenario("town").true_noise;
  const NoiseLevels scaled_noise = scaled(noise, 2.0, 0.25);
  EXPECT_EQ(scaled_noise.odometry.sigma_speed_mps, 2.0 * noise.odometry.sigma_speed_mps);
  EXPECT_EQ(scaled_noise.odometry.sigma_steering_rad, 2.0 * noise.odometry.sigma_steering_rad);
  EXPECT_EQ(scaled_noise.sigma_range_m, 0.25 * noise.sigma_range_m);
  EXPECT_EQ(scaled_noise.sigma_bearing_rad, 0.25 * noise.sigma_bearing_rad);
}

}  // namespace
}  // namespace helixnav::sim
