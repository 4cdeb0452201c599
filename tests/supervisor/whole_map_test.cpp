// SPDX-License-Identifier: BSD-3-Clause
// Odometry that was wrong by more than its noise allows: the place is found by asking the whole map.
#include <algorithm>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "campaign.hpp"
#include "circuits.hpp"
#include "helixnav/evaluation/referee.hpp"
#include "helixnav/sim/world.hpp"
#include "judged_drive.hpp"

namespace helixnav::supervisor {
namespace {

struct Drive {
  std::vector<core::WholeMapDecision> asked;
  int closed = 0, undecided = 0, refused = 0;
  double error_at_end_m = 0.0;
  std::size_t mature = 0;
};

Drive drive_through(const core::Recording& run, const NavigatorOptions& options) {
  Navigator navigator(run.start, options);
  Drive result;
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

/// A loop whose odometry has a steering error of 0.2 degrees, which its noise, assumed at a fifth, does not hold.
core::Recording biased(std::uint64_t seed) {
  sim::Scenario scenario = sim::named_scenario("two-laps");
  scenario.world.returns = 1;
  scenario.bias = {0.003, 0.01, 1e4};
  scenario.assumed_noise = sim::scaled(scenario.true_noise, 0.2, 1.0);
  return sim::simulate(scenario, seed);
}

NavigatorOptions without_learning() {
  NavigatorOptions options;
  options.noise.adapt = false;
  options.search.relocalizer.threads = 1;
  return options;
}

TEST(WholeMap, ClosesWhatOdometryForbidsByLargerNoiseOnTheLoop) {
  int helped = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const core::Recording run = biased(seed);
    const Drive drive = drive_through(run, without_learning());
    NavigatorOptions blind = without_learning();
    blind.search.whole_map = false;
    const Drive before = drive_through(run, blind);
    EXPECT_EQ(drive.undecided, 0) << "seed " << seed;
    EXPECT_GE(drive.closed, 1) << "seed " << seed;
    EXPECT_LE(drive.mature, before.mature);
    helped += before.closed == 0;
    for (const core::WholeMapDecision& asked : drive.asked) {
      if (asked.verdict != core::WholeMapDecision::Verdict::accepted) continue;
      EXPECT_GT(asked.cost, asked.limit);
      EXPECT_GT(asked.odometry_factor, 1.0);
      EXPECT_GT(asked.evidence, asked.needed);
    }
  }
  EXPECT_GE(helped, 2) << "seeds on which nothing closed without it";
}

TEST(WholeMap, FindsAVehicleThatWasCarriedAway) {
  sim::Scenario scenario = sim::named_scenario("kidnapped");
  scenario.world.tour_m = 2600.0;
  const core::Recording run = sim::simulate(scenario, 3001);
  const Drive drive = drive_through(run, {});
  const auto cut = std::count_if(drive.asked.begin(), drive.asked.end(), [](const core::WholeMapDecision& asked) {
    return asked.verdict == core::WholeMapDecision::Verdict::accepted && asked.odometry_factor == 0.0;
  });
  EXPECT_EQ(cut, 1);
  EXPECT_LT(drive.error_at_end_m, 5.0);
}

TEST(WholeMap, IsNotAskedWhereNothingIsAmiss) {
  const Drive drive = drive_through(sim::simulate(sim::named_scenario("large-loop-changed"), 1), {});
  EXPECT_EQ(drive.closed, 1);
  EXPECT_TRUE(drive.asked.empty());
}

}  // namespace
}  // namespace helixnav::supervisor
