// SPDX-License-Identifier: BSD-3-Clause
// A vehicle that was carried while nothing was measured, and nobody reported this.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "pauses.hpp"

namespace helixnav::supervisor {
namespace {

struct Found {
  std::vector<core::CarriedDecision> carried;
  std::vector<std::size_t> carried_at;  ///< scans
  int placed = 0;
  std::size_t mature = 0;
  double error_at_end_m = 0.0;
};

Found drive_through(const core::Recording& run, const NavigatorOptions& options = {}) {
  Found driven;
  Navigator navigator(run.start, options);
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    for (const core::Decision& decision : navigator.observe(scan).decisions) {
      const auto* placed = std::get_if<core::PlacedDecision>(&decision);
      driven.placed += placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted;
      if (const auto* carried = std::get_if<core::CarriedDecision>(&decision)) {
        driven.carried.push_back(*carried);
        driven.carried_at.push_back(i);
      }
    }
  });
  for (const core::MapLandmark& one : navigator.map()) driven.mature += one.state == core::LandmarkState::mature;
  const core::Pose2& truth = run.true_poses.back().T_world_robot;
  driven.error_at_end_m = (navigator.pose().mean.position_m() - truth.position_m()).norm();
  return driven;
}

/// From the hundredth scan on, a minute passes before every `every`-th scan, the vehicle standing still.
core::Recording with_waits(const core::Recording& run, std::size_t every) {
  constexpr core::Nanoseconds long_ns = 60'000'000'000;
  core::Recording waiting = run;
  std::size_t scans = 0;
  for (std::size_t i = 0; i < waiting.events.size(); ++i) {
    if (!std::holds_alternative<core::Scan>(waiting.events[i])) continue;
    if (++scans > 100 && scans % every == 0) wait_before(waiting, i, long_ns);
  }
  return waiting;
}

TEST(FoundCarried, ByTheFirstScanAfterThePause) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Found driven = drive_through(with_pauses(sim::simulate(wide_circuit(), seed), {{220, 290}}, false));
    ASSERT_EQ(driven.carried.size(), 1u);
    EXPECT_EQ(driven.carried_at[0], 220u);
    const core::CarriedDecision& carried = driven.carried[0];
    EXPECT_EQ(carried.cause, core::CarriedDecision::Cause::found_out);
    EXPECT_GT(carried.missing, carried.seen);
    EXPECT_GT(carried.unknown, 0);
    EXPECT_GT(carried.elsewhere_nats, NavigatorOptions{}.search.integrity.nats);
    EXPECT_GE(carried.landmarks, 20);
    EXPECT_EQ(driven.placed, 1);
    EXPECT_LT(driven.error_at_end_m, 0.8);
    EXPECT_LE(driven.mature, 26u) << "25 stand there: one map, not two";
  }
}

/// Nothing is in view at first where it was set down.
TEST(FoundCarried, ByALaterScanWithThoseSinceThePause) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::Recording run = with_pauses(sim::simulate(wide_circuit(), seed), {{220, 290}}, false);
    std::size_t scans = 0;
    for (core::Event& event : run.events) {
      auto* scan = std::get_if<core::Scan>(&event);
      if (scan != nullptr && scans++ >= 220 && scans <= 223) scan->observations.clear();
    }
    const Found driven = drive_through(run);
    ASSERT_EQ(driven.carried.size(), 1u);
    EXPECT_EQ(driven.carried[0].cause, core::CarriedDecision::Cause::found_out);
    ASSERT_GE(driven.carried_at[0], 221u);
    EXPECT_EQ(driven.carried[0].scans, static_cast<int>(driven.carried_at[0] - 220));
    EXPECT_LT(driven.error_at_end_m, 0.8);
  }
}

TEST(FoundCarried, IsSilentWhereAnEventSaysItToo) {
  core::Recording run = with_pauses(sim::simulate(wide_circuit(), 1), {{220, 290}}, true);
  Navigator navigator(run.start);
  int carried = 0;
  for (const core::Event& event : run.events) {
    const auto report = navigator.take(event);
    if (!report) continue;
    for (const core::Decision& decision : report->decisions) {
      const auto* one = std::get_if<core::CarriedDecision>(&decision);
      if (one == nullptr) continue;
      ++carried;
      EXPECT_EQ(one->cause, core::CarriedDecision::Cause::told);
    }
  }
  EXPECT_EQ(carried, 1);
}

/// 600 pauses: at one false alarm in 200 of them, seeing none has a probability of 5 %.
TEST(FoundCarried, NotWhereItStopped) {
  int carried = 0;
  for (std::uint64_t seed = 101; seed <= 120; ++seed) {
    carried += static_cast<int>(drive_through(with_waits(sim::simulate(wide_circuit(), seed), 10)).carried.size());
  }
  EXPECT_EQ(carried, 0);
}

/// As in a log without a clock, or with a sensor that never stops: a scan that came in time is not questioned.
TEST(FoundCarried, NotWithoutAPause) {
  const core::Recording run = without_waiting(with_pauses(sim::simulate(wide_circuit(), 1), {{220, 290}}, false));
  EXPECT_TRUE(drive_through(run).carried.empty());
}

TEST(FoundCarried, NotWithoutTheMonitor) {
  NavigatorOptions options;
  options.search.integrity.enabled = false;
  EXPECT_TRUE(
      drive_through(with_pauses(sim::simulate(wide_circuit(), 1), {{220, 290}}, false), options).carried.empty());
}

}  // namespace
}  // namespace helixnav::supervisor
