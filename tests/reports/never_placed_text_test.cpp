// SPDX-License-Identifier: BSD-3-Clause
#include "never_placed_text.hpp"

#include <cstddef>
#include <utility>

#include <gtest/gtest.h>

namespace helixnav::reports {
namespace {

core::PlacedDecision placed_as(core::PlacedDecision::Verdict verdict) {
  core::PlacedDecision placed;
  placed.verdict = verdict;
  return placed;
}

/// A session on an earlier map, carried in step 6; its second part finds its place in step 8. A scan a second.
runs::Run carried_run() {
  runs::Run run;
  for (int k = 0; k < 10; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.step = k;
    step.t_ns = k * 1'000'000'000LL;
  }
  run.steps[0].decisions.emplace_back(placed_as(core::PlacedDecision::Verdict::sought));
  core::CarriedDecision carried;
  carried.from_part = 1;
  carried.part = 2;
  run.steps[6].decisions.emplace_back(carried);
  run.steps[8].decisions.emplace_back(placed_as(core::PlacedDecision::Verdict::accepted));
  return run;
}

TEST(NeverPlaced, SaysWhenAndHowManyScans) {
  const std::string text = never_placed_text(carried_run());
  EXPECT_NE(text.find("from 0 s to 5 s (6 scans)"), std::string::npos) << text;
}

TEST(NeverPlaced, IsSilentAboutPartsThatWerePlaced) {
  runs::Run run = carried_run();
  run.steps[4].decisions.emplace_back(placed_as(core::PlacedDecision::Verdict::accepted));
  EXPECT_TRUE(never_placed_text(run).empty()) << never_placed_text(run);
}

TEST(NeverPlaced, LeavesTheLastPartToOthers) {
  runs::Run run = carried_run();
  run.steps[4].decisions.emplace_back(placed_as(core::PlacedDecision::Verdict::accepted));
  run.steps[8].decisions.clear();
  EXPECT_TRUE(never_placed_text(run).empty()) << never_placed_text(run);
}

}  // namespace
}  // namespace helixnav::reports
