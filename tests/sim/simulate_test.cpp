// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "helixnav/core/odometry.hpp"
#include "recordings.hpp"

namespace helixnav::sim {
namespace {

using testing::events_of;
using testing::odometry_bytes;
using testing::scan_bytes;
using testing::truth_bytes;

const core::TrueLandmark& landmark(const core::Recording& run, core::Label label) {
  return run.true_landmarks.at(static_cast<std::size_t>(label));
}

TEST(Simulate, GivesTheSameBytesForTheSameSeedAndOthersForAnother) {
  for (const std::string& name : scenario_names()) {
    const Scenario scenario = named_scenario(name);
    const core::Recording a = simulate(scenario, 5), b = simulate(scenario, 5), c = simulate(scenario, 6);
    EXPECT_EQ(odometry_bytes(a), odometry_bytes(b)) << name;
    EXPECT_EQ(scan_bytes(a), scan_bytes(b)) << name;
    EXPECT_EQ(truth_bytes(a), truth_bytes(b)) << name;
    EXPECT_NE(odometry_bytes(a), odometry_bytes(c)) << name;
    EXPECT_NE(scan_bytes(a), scan_bytes(c)) << name;
    EXPECT_NE(truth_bytes(a), truth_bytes(c)) << name;
  }
}

TEST(Simulate, OdometryNoiseLeavesTruthAndScansAsTheyWere) {
  Scenario scenario = named_scenario("large-loop");
  const core::Recording before = simulate(scenario, 5);
  scenario.true_noise.odometry.sigma_speed_mps *= 2.0;
  const core::Recording after = simulate(scenario, 5);
  EXPECT_NE(odometry_bytes(before), odometry_bytes(after));
  EXPECT_EQ(scan_bytes(before), scan_bytes(after));
  EXPECT_EQ(truth_bytes(before), truth_bytes(after));
}

TEST(Simulate, TheScannerLeavesTruthAndOdometryAsTheyWere) {
  Scenario scenario = named_scenario("large-loop");
  const core::Recording before = simulate(scenario, 5);
  scenario.scanner.clutter_per_scan = 3.0;
  const core::Recording after = simulate(scenario, 5);
  EXPECT_EQ(odometry_bytes(before), odometry_bytes(after));
  EXPECT_NE(scan_bytes(before), scan_bytes(after));
  EXPECT_EQ(truth_bytes(before), truth_bytes(after));
}

TEST(Simulate, ToldNoiseChangesWhatIsClaimedAndNothingElse) {
  const core::Recording honest = simulate(Scenario{}, 5);
  const core::Recording modest = simulate(named_scenario("assumed-noise-half"), 5);
  EXPECT_EQ(truth_bytes(honest), truth_bytes(modest));
  const auto u = events_of<core::Odometry>(honest), v = events_of<core::Odometry>(modest);
  ASSERT_EQ(u.size(), v.size());
  for (std::size_t i = 0; i < u.size(); ++i) {
    EXPECT_EQ(u[i].T_before_after.vector(), v[i].T_before_after.vector());
    EXPECT_LT((0.25 * u[i].covariance - v[i].covariance).norm(), 1e-12);
  }
  const auto s = events_of<core::Scan>(honest), t = events_of<core::Scan>(modest);
  for (std::size_t i = 0; i < s.size(); ++i) {
    ASSERT_EQ(s[i].observations.size(), t[i].observations.size());
    for (std::size_t j = 0; j < s[i].observations.size(); ++j) {
      EXPECT_EQ(s[i].observations[j].z, t[i].observations[j].z);
      EXPECT_LT((0.25 * s[i].observations[j].R - t[i].observations[j].R).norm(), 1e-12);
    }
  }
}

TEST(Simulate, HasATruePoseAndLabelsForEachScanAndEventsInTimeOrder) {
  for (const std::string& name : scenario_names()) {
    const core::Recording run = simulate(named_scenario(name), 1);
    const auto scans = events_of<core::Scan>(run);
    ASSERT_EQ(run.labels.size(), scans.size()) << name;
    ASSERT_EQ(run.true_poses.size(), scans.size()) << name;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      EXPECT_EQ(run.labels[i].size(), scans[i].observations.size()) << name;
      EXPECT_EQ(run.true_poses[i].t_ns, scans[i].t_ns) << name;
    }
    const auto later = [](const core::Event& a, const core::Event& b) { return time_of(a) < time_of(b); };
    EXPECT_TRUE(std::is_sorted(run.events.begin(), run.events.end(), later)) << name;
    EXPECT_EQ(run.true_poses.front().T_world_robot.vector(), Eigen::Vector3d::Zero()) << name;
    EXPECT_GT(scans.size(), 150U) << name;
  }
}

TEST(Simulate, ChainingExactOdometryReproducesTheTruth) {
  const core::Recording run = simulate(named_scenario("noise-free"), 2);
  core::Odometry chained = core::no_motion(0);
  std::size_t scan = 0;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      chained = core::chain(chained, *odometry);
    } else {
      const core::Pose2 error = core::between(chained.T_before_after, run.true_poses[scan].T_world_robot);
      ASSERT_LT(error.vector().norm(), 1e-9) << scan;
      ++scan;
    }
  }
}

TEST(Simulate, ExactObservationsAreThoseOfTheirLandmarks) {
  const core::Recording run = simulate(named_scenario("noise-free"), 2);
  const auto scans = events_of<core::Scan>(run);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (std::size_t j = 0; j < scans[i].observations.size(); ++j) {
      const core::Observation& z = scans[i].observations[j];
      const auto predicted = core::predict_observation(z.kind, run.true_poses[i].T_world_robot, scans[i].T_robot_sensor,
                                                       landmark(run, run.labels[i][j]).point_m);
      ASSERT_LT(core::innovation(z.kind, z.z, predicted.z_hat).norm(), 1e-9);
      ++seen;
    }
  }
  EXPECT_GT(seen, 1000U);
}

/// 6 sigma in either coordinate: about 1e5 observations, false alarm 4e-4 in all.
TEST(Simulate, EveryLabelledObservationMatchesItsLandmarkAndIsUsable) {
  for (const std::string& name : scenario_names()) {
    const Scenario scenario = named_scenario(name);
    const core::Recording run = simulate(scenario, 1);
    const auto scans = events_of<core::Scan>(run);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      std::set<core::Label> labels;
      for (std::size_t j = 0; j < scans[i].observations.size(); ++j) {
        const core::Observation& z = scans[i].observations[j];
        ASSERT_NO_THROW(core::check_observation(z)) << name;
        if (run.labels[i][j] == core::no_label) continue;
        ASSERT_TRUE(labels.insert(run.labels[i][j]).second) << name << ": one landmark twice in a scan";
        const auto predicted = core::predict_observation(
            z.kind, run.true_poses[i].T_world_robot, scans[i].T_robot_sensor, landmark(run, run.labels[i][j]).point_m);
        const core::ObsVector nu = core::innovation(z.kind, z.z, predicted.z_hat);
        ASSERT_LE(std::abs(nu[0]), 6.0 * scenario.true_noise.sigma_range_m + 1e-9) << name;
        ASSERT_LE(std::abs(nu[1]), 6.0 * scenario.true_noise.sigma_bearing_rad + 1e-9) << name;
      }
    }
  }
}

TEST(Simulate, ClutterLiesInTheFieldOfView) {
  const core::Recording run = simulate(named_scenario("sparse"), 1);
  const auto scans = events_of<core::Scan>(run);
  std::size_t clutter = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (std::size_t j = 0; j < scans[i].observations.size(); ++j) {
      if (run.labels[i][j] != core::no_label) continue;
      const core::ObsVector& z = scans[i].observations[j].z;
      const core::FieldOfView& view = scans[i].field_of_view;
      EXPECT_TRUE(z[0] >= view.min_range_m && z[0] <= view.max_range_m);
      EXPECT_TRUE(z[1] >= view.min_bearing_rad && z[1] <= view.max_bearing_rad);
      ++clutter;
    }
  }
  EXPECT_GT(clutter, 300U);
}

TEST(Simulate, OpenRoadNeverSeesALandmarkAgainAfterItsBareStretch) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const core::Recording run = simulate(named_scenario("open-road"), seed);
    const std::size_t last_part = run.labels.size() - 120;  // 180 m at 1.5 m a scan
    std::set<core::Label> early, late;
    for (std::size_t i = 0; i < run.labels.size(); ++i) {
      if (i >= last_part - 60 && i < last_part) continue;  // bare
      (i < last_part ? early : late).insert(run.labels[i].begin(), run.labels[i].end());
    }
    std::vector<core::Label> both;
    std::set_intersection(early.begin(), early.end(), late.begin(), late.end(), std::back_inserter(both));
    EXPECT_EQ(both, std::vector<core::Label>{core::no_label}) << seed;
  }
}

TEST(Simulate, FelledTreesAreNotSeenAfterwardsNorNewOnesBefore) {
  const Scenario scenario = named_scenario("large-loop-changed");
  const World world = build_world(scenario.world, 4);
  const core::Recording run = simulate_in(world, scenario, 4);
  const auto change_scan = static_cast<std::size_t>((world.returns_at_m[0] - 45.0) / 1.5);
  std::size_t old_seen = 0, new_seen = 0;
  for (std::size_t i = 0; i < run.labels.size(); ++i) {
    if (i + 5 > change_scan && i < change_scan + 5) continue;  // the vehicle cuts corners a little
    for (const core::Label label : run.labels[i]) {
      if (label == core::no_label) continue;
      const Stretch& present = world.trees[static_cast<std::size_t>(label)].present;
      EXPECT_TRUE(i < change_scan ? present.from_m == 0.0 : present.to_m > world.drive_m) << i;
      ++(present.from_m > 0.0 ? new_seen : old_seen);
    }
  }
  EXPECT_GT(old_seen, 500U);
  EXPECT_GT(new_seen, 20U);
}

TEST(Simulate, SeesNothingInABlackout) {
  const Scenario scenario = named_scenario("blackout");
  const World world = build_world(scenario.world, 1);
  ASSERT_TRUE(world.blackout.has_value());
  const core::Recording run = simulate_in(world, scenario, 1);
  const auto middle = static_cast<std::size_t>(0.5 * (world.blackout->from_m + world.blackout->to_m) / 1.5);
  for (std::size_t i = middle - 12; i < middle + 12; ++i) EXPECT_TRUE(run.labels[i].empty()) << i;
  const auto scans = events_of<core::Scan>(run);
  EXPECT_EQ(scans.size(), run.labels.size());  // empty scans are events too
}

TEST(Simulate, TrunksHideWhatStandsBehindThem) {
  Scenario scenario = named_scenario("noise-free");
  const World world{Route({{0.0, 0.0}, {60.0, 0.0}}),
                    3.0,
                    {{{20.0, 0.5}, {0.0, 1e9}}, {{28.0, 0.55}, {0.0, 1e9}}, {{28.0, 5.0}, {0.0, 1e9}}},
                    {},
                    {}};
  const auto labels_of_first_scan = [&] {
    std::vector<core::Label> labels = simulate_in(world, scenario, 1).labels.front();
    std::sort(labels.begin(), labels.end());
    return labels;
  };
  EXPECT_EQ(labels_of_first_scan(), (std::vector<core::Label>{0, 1, 2}));
  scenario.scanner.occluding_radius_m = 0.5;
  EXPECT_EQ(labels_of_first_scan(), (std::vector<core::Label>{0, 2}));
}

TEST(Simulate, TheVehicleKeepsToItsRoute) {
  for (const std::string& name : scenario_names()) {
    const Scenario scenario = named_scenario(name);
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      const World world = build_world(scenario.world, seed);
      const core::Recording run = simulate_in(world, scenario, seed);
      for (std::size_t i = 0; i < run.true_poses.size(); i += 20) {
        ASSERT_LT(world.route.distance_m(run.true_poses[i].T_world_robot.position_m()), 0.6) << name << " " << seed;
      }
    }
  }
}

}  // namespace
}  // namespace helixnav::sim
