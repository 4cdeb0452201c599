// SPDX-License-Identifier: BSD-3-Clause
#include "scans_apart.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "helixnav/reports/run_warnings.hpp"

namespace helixnav::reports {
namespace {

/// Scans `between_m` apart that show trees up to 30 m ahead, none of which is ever matched.
runs::Run unmatched_run(double between_m) {
  runs::Run run;
  for (int k = 0; k < 20; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.pose.mean = core::Pose2(between_m * k, 0.0, 0.0);
    auto& scan = run.scans.emplace_back();
    for (int i = 0; i < 30; ++i) {
      scan.emplace_back(static_cast<float>(i), 5.0f);
      step.associations.push_back({i, core::Outcome::augmented});
    }
    scan.back().setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  run.map.emplace_back().state = core::LandmarkState::mature;
  return run;
}

std::string first_warning(const runs::Run& run) { return warnings_of(run, evaluation::evaluate(run)).front(); }

TEST(ScansApart, AreBlamedForMatchingThatCollapsed) {
  const std::string text = first_warning(unmatched_run(18.0));
  EXPECT_NE(text.find("scans are 18 m apart"), std::string::npos) << text;
  EXPECT_EQ(text.find("worse than assumed"), std::string::npos) << text;
}

TEST(ScansApart, AreNotBlamedWhereThreeScansShowALandmark) {
  EXPECT_TRUE(scans_apart_text(unmatched_run(8.0)).empty());
  EXPECT_NE(first_warning(unmatched_run(8.0)).find("worse than assumed"), std::string::npos);
}

TEST(ScansApart, AreNotKnownOfARunWithoutScans) {
  runs::Run run = unmatched_run(18.0);
  run.scans.clear();
  EXPECT_TRUE(scans_apart_text(run).empty());
}

}  // namespace
}  // namespace helixnav::reports
