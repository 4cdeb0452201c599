// SPDX-License-Identifier: BSD-3-Clause
// Odometry that was wrong by more than its noise allows: the place is found by asking the whole map.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "circuits.hpp"
#include "closing/close_against_odometry.hpp"
#include "helixnav/core/angle.hpp"
#include "judged_drive.hpp"
#include "pauses.hpp"

namespace helixnav::supervisor {
namespace {

struct Asking {
  std::vector<core::WholeMapDecision> asked;
  int closed = 0, undecided = 0, refused = 0;
  double error_at_end_m = 0.0;
  std::size_t mature = 0;
};

Asking drive_asking(const core::Recording& run, const NavigatorOptions& options) {
  Navigator navigator(run.start, options);
  Asking result;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    const core::StepReport report = navigator.observe(scan);
    for (const core::Decision& decision : report.decisions) {
      if (const auto* asked = std::get_if<core::WholeMapDecision>(&decision)) result.asked.push_back(*asked);
      if (const auto* closure = std::get_if<core::ClosureDecision>(&decision)) {
        ++(closure->accepted ? result.closed : result.refused);
      }
      if (std::holds_alternative<core::UndecidedDecision>(decision)) ++result.undecided;
    }
    const core::Pose2& truth = run.true_poses[i].T_world_robot;
    result.error_at_end_m = (report.pose.mean.position_m() - truth.position_m()).norm();
  });
  for (const core::MapLandmark& one : navigator.map()) result.mature += one.state == core::LandmarkState::mature;
  return result;
}

/// A loop whose odometry has slow steering and speed errors that its noise, assumed at a tenth, does not cover.
core::Recording biased(std::uint64_t seed) {
  sim::Scenario scenario = sim::named_scenario("large-loop-changed");
  scenario.bias = {0.002, 0.01, 1e4};
  scenario.assumed_noise = sim::scaled(scenario.true_noise, 0.1, 1.0);
  return sim::simulate(scenario, seed);
}

NavigatorOptions without_learning() {
  NavigatorOptions options;
  options.noise.adapt = false;
  options.search.relocalizer.threads = 1;
  return options;
}

/// 18 rows, three of which are the pose's.
Closing refused_with(double cost) {
  Closing closing;
  closing.cost = cost;
  closing.dof = 18;
  return closing;
}

TEST(WholeMap, APlaceThatOdometryForbidsNeedsMoreEvidence) {
  EXPECT_EQ(nats_against_odometry(refused_with(15.0)), 0.0) << "its noise would have to be no larger";
  EXPECT_EQ(nats_against_odometry(refused_with(17.0)), 0.0);
  EXPECT_NEAR(nats_against_odometry(refused_with(15.0 + 3.0 * 4.0)), 1.5 * std::log(4.0), 1e-12)
      << "a variance four times as large";
  EXPECT_NEAR(nats_against_odometry(refused_with(3e6)), std::log(1e6), 1e-12) << "something else was wrong";
}

/// All around within 15 m is seen, every half metre of a straight drive.
core::Recording drive_past(const std::vector<Eigen::Vector2d>& trees_m, double length_m) {
  constexpr double step_m = 0.5, reach_m = 15.0;
  core::Recording run;
  for (int k = 0; k * step_m <= length_m; ++k) {
    const core::Nanoseconds t_ns = core::nanoseconds_from_seconds(0.1 * k);
    if (k > 0) {
      core::Odometry moved = core::no_motion(t_ns);
      moved.T_before_after = {step_m, 0.0, 0.0};
      moved.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
      run.events.emplace_back(moved);
    }
    core::Scan scan;
    scan.t_ns = t_ns;
    scan.field_of_view = {0.5, reach_m, -core::pi, core::pi, reach_m};
    for (const Eigen::Vector2d& tree_m : trees_m) {
      const Eigen::Vector2d seen_m = tree_m - Eigen::Vector2d(k * step_m, 0.0);
      if (seen_m.norm() > reach_m) continue;
      scan.observations.push_back(
          core::make_range_bearing(seen_m.norm(), std::atan2(seen_m.y(), seen_m.x()), 0.05, 0.005));
    }
    run.events.emplace_back(std::move(scan));
    run.true_poses.push_back({t_ns, {k * step_m, 0.0, 0.0}});
  }
  return run;
}

// An all-round sensor loses what it passes after two reaches; what was mapped since a branch may have begun goes back
// further. A landmark is on only one side of the question.
TEST(WholeMap, ComparesNoLandmarkWithItself) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    core::RandomStream random(seed, "trees");
    std::vector<Eigen::Vector2d> trees_m;
    for (int k = 0; k < 12; ++k) trees_m.push_back({random.uniform(-13.9, -12.4), random.uniform(-9.0, 9.0)});
    for (int k = 0; k < 20; ++k) trees_m.push_back({random.uniform(30.0, 50.0), random.uniform(-9.0, 9.0)});
    const Asking drive = drive_asking(drive_past(trees_m, 45.0), without_learning());
    EXPECT_TRUE(drive.asked.empty()) << "seed " << seed;
    EXPECT_LT(drive.error_at_end_m, 0.1) << "seed " << seed;
  }
}

// An index of old ground extends over 2000 reaches, 30 km here; a road may be longer.
TEST(WholeMap, AsksOnARoadLongerThanItsIndex) {
  core::RandomStream random(1, "trees");
  const auto stretch = [&] {
    std::vector<Eigen::Vector2d> trees_m;
    for (int k = 0; k < 60; ++k) trees_m.push_back({random.uniform(0.0, 120.0), random.uniform(-9.0, 9.0)});
    return drive_past(trees_m, 120.0);
  };
  core::Recording run = stretch(), later = stretch();
  wait_before(later, 0, core::time_of(run.events.back()));
  core::Odometry far = core::no_motion(core::time_of(run.events.back()));
  far.T_before_after.x_m = 4e4;
  far.covariance = Eigen::Vector3d(1.0, 1.0, 1e-6).asDiagonal();
  run.events.emplace_back(far);
  run.events.insert(run.events.end(), later.events.begin(), later.events.end());
  run.true_poses.insert(run.true_poses.end(), later.true_poses.begin(), later.true_poses.end());
  const Asking drive = drive_asking(run, without_learning());
  EXPECT_EQ(drive.closed, 0);
  EXPECT_GE(drive.mature, 115U);
}

/// On most seeds the search does it alone; these are those of 1 to 16 that it leaves open or closes only in part. In
/// the first of them, no noise on the loop fits the pairs that are there once they are believed, and it is cut.
TEST(WholeMap, ClosesWhatOdometryForbidsByLargerNoiseOnTheLoop) {
  int by_noise = 0;
  for (const std::uint64_t seed : {3u, 5u, 16u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const core::Recording run = biased(seed);
    const Asking drive = drive_asking(run, without_learning());
    NavigatorOptions prior_only = without_learning();
    prior_only.search.whole_map = false;
    const Asking before = drive_asking(run, prior_only);
    EXPECT_GE(drive.closed, 1);
    EXPECT_EQ(drive.undecided, 0);
    EXPECT_LT(drive.mature, before.mature) << "duplicates";
    ASSERT_FALSE(drive.asked.empty());
    const core::WholeMapDecision& last = drive.asked.back();
    EXPECT_EQ(last.verdict, core::WholeMapDecision::Verdict::accepted);
    EXPECT_GT(last.cost, last.limit);
    EXPECT_NE(last.odometry_factor, 1.0) << "as measured odometry forbids it";
    by_noise += last.odometry_factor > 1.0 ? 1 : 0;
    EXPECT_GT(last.evidence, last.needed);
  }
  EXPECT_GE(by_noise, 2);
}

/// If no pause reveals that it was (found_carried_test.cpp).
TEST(WholeMap, FindsAVehicleThatWasCarriedAway) {
  sim::Scenario scenario = sim::named_scenario("kidnapped");
  scenario.world.tour_m = 2600.0;
  const core::Recording run = without_waiting(sim::simulate(scenario, 3001));
  const Asking drive = drive_asking(run, {});
  const auto cut = std::count_if(drive.asked.begin(), drive.asked.end(), [](const core::WholeMapDecision& asked) {
    return asked.verdict == core::WholeMapDecision::Verdict::accepted && asked.odometry_factor == 0.0;
  });
  EXPECT_EQ(cut, 1);
  EXPECT_LT(drive.error_at_end_m, 5.0);
}

/// A slip by about one pitch of the orchard, discovered 60 m later: the trees it was among were seen up to then, and are not old.
TEST(WholeMap, MergesCopiesOfTreesThatWereNotOldWhenTheSearchBegan) {
  sim::Scenario scenario = sim::named_scenario("orchard");
  scenario.slip.every_m = 200.0;
  scenario.slip.distance_m = {2.0, 2.0};
  scenario.slip.turn_rad = {10.0 * core::pi / 180.0, 10.0 * core::pi / 180.0};
  const core::Recording run = sim::simulate(scenario, 6400039);
  std::set<core::Label> standing;
  for (const std::vector<core::Label>& scan : run.labels) standing.insert(scan.begin(), scan.end());
  standing.erase(core::no_label);
  const Asking drive = drive_asking(run, {});
  EXPECT_TRUE(std::any_of(drive.asked.begin(), drive.asked.end(), [](const core::WholeMapDecision& asked) {
    return asked.verdict == core::WholeMapDecision::Verdict::accepted && asked.odometry_factor != 1.0;
  }));
  EXPECT_LE(drive.mature, standing.size()) << "49 trees twice";
}

/// A slip on bare ground between two stretches, discovered on the second: the first fits the next row of the orchard in places.
TEST(WholeMap, MergesNoFewCopiesThatOnlyOdometryTies) {
  sim::Scenario scenario = sim::named_scenario("orchard");
  scenario.slip.every_m = 500.0;
  scenario.slip.distance_m = {2.0, 2.0};
  scenario.slip.turn_rad = {10.0 * core::pi / 180.0, 10.0 * core::pi / 180.0};
  const evaluation::RunScore score = navigate_and_judge(scenario, 1046);
  ASSERT_FALSE(score.closures.empty());
  for (const evaluation::ClosureScore& closure : score.closures) EXPECT_EQ(closure.wrong_pairs, 0) << "6 of 14";
}

/// Where it was set down, it matched trees arranged like those it expected.
TEST(WholeMap, LeavesOutMatchesThatContradictThePlace) {
  const core::Recording run = without_waiting(sim::simulate(sim::named_scenario("kidnapped"), 3019));
  std::set<core::Label> standing;
  for (const std::vector<core::Label>& scan : run.labels) standing.insert(scan.begin(), scan.end());
  standing.erase(core::no_label);
  const Asking drive = drive_asking(run, {});
  EXPECT_LE(drive.mature, standing.size()) << "duplicates; 155 of them as long as these matches were believed";
  EXPECT_LT(drive.error_at_end_m, 5.0);
}

/// Set down on a bare street, in a drive that is not kept as a whole: the search began 70 m before.
TEST(WholeMap, CutsWhereNothingMappedBeforeWasSeenAnyMore) {
  core::Recording run = sim::simulate(sim::named_scenario("kidnapped"), 3400022);
  run = without_waiting(run, run.true_carries_ns.back());  // else the pause reveals where (part_at_pause_test.cpp)
  const Asking drive = drive_asking(run, {});
  EXPECT_LT(drive.error_at_end_m, 5.0) << "300 with the jump where the search began: every place was refused";
}

/// After half a turn and 250 m that odometry knows nothing of, in a part that was joined to the map before; no pause reveals when.
TEST(WholeMap, KeepsTheCovariancePositiveDefinite) {
  core::Recording run = sim::simulate(sim::named_scenario("kidnapped"), 3100023);
  run = without_waiting(run, run.true_carries_ns.back());
  Navigator navigator(run.start);
  int placed = 0;
  for (const core::Event& event : run.events) {
    const std::optional<core::StepReport> report = navigator.take(event);
    if (!report) continue;
    for (const core::Decision& decision : report->decisions) {
      const auto* asked = std::get_if<core::WholeMapDecision>(&decision);
      if (asked == nullptr || asked->verdict != core::WholeMapDecision::Verdict::accepted) continue;
      ++placed;
      std::vector<core::LandmarkId> ids;
      for (const core::MapLandmark& landmark : navigator.map()) ids.push_back(landmark.id);
      const Eigen::MatrixXd covariance = navigator.joint(ids).covariance;
      const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(covariance).eigenvalues();
      EXPECT_GT(values[0], 0.0) << "-0.03 m^2 with a jump as uncertain as it is large";
    }
  }
  EXPECT_GE(placed, 1);
}

/// Trees, by label, seen from the beginning of the search on that had been seen before and out of sight for a while.
int old_trees_seen(const core::Recording& run, std::size_t trigger, std::size_t end) {
  constexpr std::size_t lately = 130;  // scans: 65 m
  const std::size_t left = trigger > lately ? trigger - lately : 0;
  std::set<core::Label> before, recent, seen;
  for (std::size_t i = 0; i <= end; ++i) {
    std::set<core::Label>& when = i < left ? before : i < trigger ? recent : seen;
    for (const core::Label label : run.labels[i]) {
      if (label >= 0) when.insert(label);
    }
  }
  return static_cast<int>(std::count_if(seen.begin(), seen.end(), [&](core::Label label) {
    return before.count(label) > 0 && recent.count(label) == 0;
  }));
}

TEST(WholeMap, EndsASearchOnNewGround) {
  const core::Recording run = sim::simulate(sim::named_scenario("slip"), 3105);
  constexpr std::size_t scans = 1400;  // the first such search ends at 1366
  NavigatorOptions options;
  options.search.relocalizer.threads = 1;
  Navigator navigator(run.start, options);
  std::size_t trigger = 0;
  int new_ground = 0;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    if (i >= scans) return;
    for (const core::Decision& decision : navigator.observe(scan).decisions) {
      if (core::is_trigger(decision)) trigger = i;
      if (!std::holds_alternative<core::NewGroundDecision>(decision)) continue;
      ++new_ground;
      EXPECT_EQ(old_trees_seen(run, trigger, i), 0) << "search of scans " << trigger << " to " << i;
    }
  });
  EXPECT_GE(new_ground, 1);
}

/// A few trees of a crossing street, then a bare one: the search waits until there is something to see again, and decides
/// with that. It was given up after 60 m of nothing.
TEST(WholeMap, DecidesNothingOnBareGround) {
  sim::Scenario scenario = sim::named_scenario("town");
  scenario.world.tour_m = 8000.0;
  const core::Recording run = sim::simulate(scenario, 2800003);
  constexpr std::size_t scans = 1500;  // two searches were undecided at 1223 and 1442
  NavigatorOptions options;
  options.search.relocalizer.threads = 1;
  Navigator navigator(run.start, options);
  int ended = 0;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    if (i >= scans) return;
    for (const core::Decision& decision : navigator.observe(scan).decisions) {
      EXPECT_FALSE(std::holds_alternative<core::UndecidedDecision>(decision)) << "scan " << i;
      const bool ends = std::holds_alternative<core::NewGroundDecision>(decision) ||
                        std::holds_alternative<core::ClosureDecision>(decision);
      if (ends) ++ended;
    }
  });
  EXPECT_GE(ended, 2);
}

TEST(WholeMap, HasNoNewsWhereNothingIsAmiss) {
  const Asking drive = drive_asking(sim::simulate(sim::named_scenario("large-loop-changed"), 1), {});
  EXPECT_EQ(drive.closed, 1);
  EXPECT_TRUE(drive.asked.empty());
}

}  // namespace
}  // namespace helixnav::supervisor
