// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <gtest/gtest.h>

#include "calibrate/spoilt_log.hpp"
#include "drive/taken_out.hpp"
#include "program.hpp"

namespace helixnav::apps {
namespace {

core::SystematicDecision decision(double too_long, double short_m) {
  core::SystematicDecision d;
  d.too_long = too_long;
  d.short_m = short_m;
  return d;
}

TEST(TakenOut, IsTheLastTotalOfARun) {
  runs::Run run;
  run.steps.resize(5);
  EXPECT_TRUE(taken_out_of(run).are_zero());
  run.steps[1].decisions = {decision(0.01, 0.0)};
  run.steps[4].decisions = {decision(0.02, 0.1)};
  EXPECT_EQ(taken_out_of(run).too_long, 0.02);
  EXPECT_EQ(taken_out_of(run).short_m, 0.1);
}

TEST(TakenOut, RecordingsLoseIt) {
  core::Recording recording;
  core::Odometry odometry;
  odometry.T_before_after = {1.02, 0.0, 0.1};
  core::Scan scan;
  scan.observations = {core::make_range_bearing(5.0, 0.2, 0.1, 0.01)};
  recording.events = {odometry, scan};
  runs::Run run;
  run.steps.resize(1);
  const core::Recording same = without_taken_out(run, recording);
  EXPECT_EQ(std::get<core::Odometry>(same.events[0]).T_before_after.x_m, 1.02);
  run.steps[0].decisions = {decision(0.02, 0.1)};
  const core::Recording without = without_taken_out(run, recording);
  EXPECT_NEAR(std::get<core::Odometry>(without.events[0]).T_before_after.x_m, 1.0, 1e-12);
  EXPECT_NEAR(std::get<core::Scan>(without.events[1]).observations[0].z(0), 5.1, 1e-12);
}

int slips_in(const std::filesystem::path& run) {
  const std::string decisions = text_of(run / "decisions.csv");
  int slips = 0;
  for (std::size_t at = decisions.find("slip,accepted"); at != std::string::npos; ++slips) {
    at = decisions.find("slip,accepted", at + 1);
  }
  return slips;
}

/// A log all of whose constants are wrong: what is learnt makes it right, is said, and can be turned off.
/// Nobody measured how long the increment after the event took.
TEST(TakenOut, NoTurnIsTakenOutOfTheTimeInWhichAVehicleWasCarried) {
  core::Recording recording;
  core::Odometry odometry;
  for (int k = 0; k < 30; ++k) {
    odometry.t_ns = core::nanoseconds_from_seconds(k);
    recording.events.emplace_back(odometry);
  }
  recording.events.emplace_back(core::Lost{odometry.t_ns});
  odometry.t_ns = core::nanoseconds_from_seconds(600.0);
  recording.events.emplace_back(odometry);
  runs::Run run;
  run.steps.resize(1);
  core::SystematicDecision turns;
  turns.turn_rad_per_s = 0.01;
  run.steps[0].decisions = {turns};
  const core::Recording without = without_taken_out(run, recording);
  EXPECT_NEAR(std::get<core::Odometry>(without.events[29]).T_before_after.heading_rad, -0.01, 1e-12);
  const auto& after = std::get<core::Odometry>(without.events.back());
  EXPECT_EQ(after.T_before_after.heading_rad, 0.0);
  EXPECT_EQ(after.covariance(2, 2), 0.0);
}

TEST(TakenOut, ASpoiltLogIsNavigatedRight) {
  const testing::TemporaryFolder folder;
  write_spoilt_log(219, folder.path() / "log");
  const auto replayed = [&](const std::string& name, const std::string& learn) {
    return run(
        {"replay", folder.path() / "log", "--out", folder.path() / name, "--quiet", "--noise.systematic", learn});
  };
  const Outcome off = replayed("off", "false");
  EXPECT_EQ(off.err.find("taken out while driving"), std::string::npos) << off.err;
  const Outcome on = replayed("on", "true");
  EXPECT_NE(on.err.find("taken out while driving"), std::string::npos) << on.err;
  EXPECT_NE(text_of(folder.path() / "on" / "decisions.csv").find("systematic,taken-out"), std::string::npos);
  const Outcome explained = run({"explain", folder.path() / "on"});
  EXPECT_NE(explained.out.find("Constant errors"), std::string::npos) << explained.out;
  EXPECT_GE(slips_in(folder.path() / "off"), 10) << "none of which happened";
  EXPECT_LE(slips_in(folder.path() / "on"), 4);
}

}  // namespace
}  // namespace helixnav::apps
