// SPDX-License-Identifier: BSD-3-Clause
#include "slip_spans.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace helixnav::reports {
namespace {

/// A scan every 0.2 s; the vehicle slips by 0.16 m in each of the given ones.
runs::Run run_with_slips(const std::vector<std::size_t>& scans) {
  runs::Run run;
  for (int k = 0; k < 100; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.step = k;
    step.t_ns = core::nanoseconds_from_seconds(0.2 * k);
  }
  core::SlipDecision slip;
  slip.moved_m = 0.16;
  for (const std::size_t scan : scans) run.steps[scan].decisions.emplace_back(slip);
  return run;
}

TEST(SlipSpans, OfScansOneAfterTheOtherAreOneSlip) {
  const runs::Run run = run_with_slips({11, 12, 13, 16, 17});
  const std::vector<SlipSpan> slips = slip_spans(run);
  ASSERT_EQ(slips.size(), 1U);
  EXPECT_EQ(slips[0].scans, 5);
  EXPECT_NEAR(slips[0].moved_m, 0.8, 1e-12);
  EXPECT_EQ(when_slipped(run, slips[0]), "from 2.2 to 3.4 s");
  EXPECT_NE(slips_text(run).find("steps 11 to 17 (from 2.2 to 3.4 s)  The vehicle slipped by 0.8 m in all, found in 5"),
            std::string::npos)
      << slips_text(run);
}

TEST(SlipSpans, WithThreeScansBetweenAreTwo) {
  const runs::Run run = run_with_slips({11, 15});
  ASSERT_EQ(slip_spans(run).size(), 2U);
  EXPECT_EQ(when_slipped(run, slip_spans(run)[1]), "at 3 s");
}

TEST(SlipSpans, AreNoneWhereNothingSlipped) {
  EXPECT_TRUE(slip_spans(run_with_slips({})).empty());
  EXPECT_EQ(slips_text(run_with_slips({})), "");
}

}  // namespace
}  // namespace helixnav::reports
