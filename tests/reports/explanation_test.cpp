// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/reports/explanation.hpp"

#include <string>

#include <gtest/gtest.h>

namespace helixnav::reports {
namespace {

/// Two observations a scan: one matched, one ambiguous.
runs::Run run_of(int steps) {
  runs::Run run;
  run.path = "run";
  for (int k = 0; k < steps; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.step = k;
    step.associations.resize(2);
    step.associations[0].outcome = core::Outcome::matched;
    step.associations[1].outcome = core::Outcome::ambiguous;
  }
  return run;
}

bool says(const runs::Run& run, const std::string& words) { return explain_run(run).find(words) != std::string::npos; }

TEST(Explanation, SaysOfADriveWithoutASearchThatThereWasNone) {
  const runs::Run run = run_of(10);
  EXPECT_TRUE(says(run, "No return was ambiguous enough for a search"));
  EXPECT_TRUE(says(run, "Observations: 10 matched, 0 began landmarks, 10 ambiguous and left out, 0 rejected."));
  EXPECT_FALSE(says(run, "Slips"));
  EXPECT_FALSE(says(run, "What moves"));
}

TEST(Explanation, SaysWhatSlippedAndWhatMovesBesideASearch) {
  runs::Run run = run_of(40);
  core::SlipDecision slip;
  slip.moved_m = 0.5;
  run.steps[3].decisions = {slip, core::MovingDecision{2, 13.0, 1.5}};
  EXPECT_TRUE(says(run, "No return was ambiguous enough for a search")) << explain_run(run);
  EXPECT_TRUE(says(run, "Slips that the odometry did not show, 1:\n  step 3 (0 s)  The vehicle slipped"));
  EXPECT_TRUE(says(run, "What moves, 1:\n  step 3 (0 s)  Something that moves, at 1.5 m/s")) << explain_run(run);
  run.steps[20].decisions = {core::UndecidedDecision{}};
  EXPECT_FALSE(says(run, "No return was ambiguous enough for a search"));
  EXPECT_TRUE(says(run, "Slips that the odometry did not show, 1:"));
}

TEST(Explanation, ListsTheFirstOfManyAndCountsTheOthers) {
  runs::Run run = run_of(12);
  for (core::StepReport& step : run.steps) step.decisions = {core::MovingDecision{1, 13.0, 1.5}};
  EXPECT_TRUE(says(run, "What moves, 12:")) << explain_run(run);
  EXPECT_TRUE(says(run, "  step 4 ("));
  EXPECT_FALSE(says(run, "  step 5 ("));
  EXPECT_TRUE(says(run, "  And 7 more in decisions.csv.\n"));
}

}  // namespace
}  // namespace helixnav::reports
