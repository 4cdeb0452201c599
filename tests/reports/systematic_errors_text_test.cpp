// SPDX-License-Identifier: BSD-3-Clause
#include "systematic_errors_text.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"
#include "helixnav/reports/decision_sentence.hpp"

namespace helixnav::reports {
namespace {

TEST(SystematicErrorsText, NamesWhatIsNotZeroWithItsSide) {
  core::SystematicDecision d;
  d.too_long = -0.02;
  d.turn_rad_per_s = 0.5 * core::pi / 180.0;
  d.heading_rad = -core::pi / 180.0;
  d.short_m = 0.1;
  EXPECT_EQ(systematic_errors_text(d),
            "odometry distances are 2 % too short (or ranges too long), odometry turns 0.5 deg per second too far to "
            "the left, sensors point 1 deg farther to the right than heading_deg says, ranges are 0.100 m too short");
  d = {};
  d.turn_rad_per_m = -0.1 * core::pi / 180.0;
  EXPECT_EQ(systematic_errors_text(d), "odometry turns 0.1 deg per metre too far to the right");
}

TEST(SystematicErrorsText, AWarningGivesTheLastTotalsAndTheFirstStep) {
  runs::Run run;
  EXPECT_TRUE(systematic_errors_texts(run).empty());
  run.steps.resize(9);
  core::SystematicDecision d;
  d.short_m = 0.08;
  d.stretches = 4;
  d.nats = 30.0;
  run.steps[3].decisions = {d};
  d.short_m = 0.1;
  run.steps[7].decisions = {d};
  const std::vector<std::string> texts = systematic_errors_texts(run);
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_NE(texts[0].find("ranges are 0.100 m too short; taken out while driving, which was possible from step 3 on"),
            std::string::npos)
      << texts[0];
  EXPECT_NE(sentence_of(d).find("This explains 4 stretches of the drive 30 nats better than before"), std::string::npos)
      << sentence_of(d);
}

TEST(SystematicErrorsText, AWarningSaysWhatWasPutBack) {
  runs::Run run;
  run.steps.resize(9);
  core::SystematicDecision d;
  d.turn_rad_per_m = 0.1 * core::pi / 180.0;
  run.steps[3].decisions = {d};
  d.turn_rad_per_m = 0.0;
  run.steps[7].decisions = {d};
  const std::vector<std::string> texts = systematic_errors_texts(run);
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_NE(
      texts[0].find("odometry turns 0.1 deg per metre too far to the left were taken out from step 3 on, and what "
                    "had changed was put back until step 7"),
      std::string::npos)
      << texts[0];
  EXPECT_NE(sentence_of(d).find("was put back"), std::string::npos) << sentence_of(d);
}

}  // namespace
}  // namespace helixnav::reports
