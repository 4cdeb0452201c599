// SPDX-License-Identifier: BSD-3-Clause
#include "wrong_place_text.hpp"

#include <gtest/gtest.h>

namespace helixnav::reports {
namespace {

runs::Run run_placed_at(double s) {
  runs::Run run;
  for (int k = 0; k < 100; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.t_ns = core::nanoseconds_from_seconds(k);
    step.pose.mean = {250.0, 40.0, 0.2};
  }
  core::PlacedDecision placed;
  placed.verdict = core::PlacedDecision::Verdict::accepted;
  placed.T_map_session = {700.0, 0.0, 0.0};
  run.steps[static_cast<std::size_t>(s)].decisions = {placed};
  return run;
}

TEST(WrongPlaceText, SaysWhenAndHowFarThePoseWasOff) {
  runs::Run run = run_placed_at(20.0);
  EXPECT_TRUE(wrong_place_text(run).empty());
  core::CarriedDecision again;
  again.cause = core::CarriedDecision::Cause::wrong_place;
  core::PlacedDecision placed;
  placed.verdict = core::PlacedDecision::Verdict::accepted;
  placed.T_map_session = {-200.0, 0.0, 0.0};  // from where it had been placed
  run.steps[70].decisions = {again, placed};
  const std::string text = wrong_place_text(run);
  EXPECT_NE(text.find("from 20 s to 70 s"), std::string::npos) << text;
  EXPECT_NE(text.find("200 m off"), std::string::npos) << text;
}

TEST(WrongPlaceText, OfAVehicleThatWasCarriedSaysNothing) {
  runs::Run run = run_placed_at(20.0);
  run.steps[10].decisions = {core::CarriedDecision()};
  EXPECT_TRUE(wrong_place_text(run).empty());
}

}  // namespace
}  // namespace helixnav::reports
