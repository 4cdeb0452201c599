// SPDX-License-Identifier: BSD-3-Clause
#include "closing_warnings.hpp"

#include <gtest/gtest.h>

namespace helixnav::reports {
namespace {

core::ClosureDecision closure(bool accepted) {
  core::ClosureDecision decision;
  decision.accepted = accepted;
  return decision;
}

core::SmoothingDecision solved(bool accepted) {
  core::SmoothingDecision decision;
  decision.accepted = accepted;
  return decision;
}

runs::Run run_of(const std::vector<core::Decision>& decisions) {
  runs::Run run;
  for (const core::Decision& decision : decisions) run.steps.emplace_back().decisions = {decision};
  return run;
}

TEST(ClosingWarnings, SayThatReturnsStayedOpenWhereMostClosingsWereRefused) {
  const auto texts =
      closing_warnings(run_of({closure(true), solved(true), closure(false), closure(false), closure(false)}));
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_NE(texts[0].find("1 closing accepted, 3 refused"), std::string::npos) << texts[0];
}

TEST(ClosingWarnings, SayNothingOfReturnsThatWereClosedAtLast) {
  const core::ClosureDecision refused = closure(false);
  EXPECT_TRUE(closing_warnings(run_of({refused, refused, refused, refused, closure(true), solved(true)})).empty());
  const auto texts =
      closing_warnings(run_of({refused, refused, refused, refused, refused, closure(true), solved(true)}));
  ASSERT_EQ(texts.size(), 1u) << "again and again";
  EXPECT_NE(texts[0].find("refused 5 times, 1 were accepted"), std::string::npos) << texts[0];
}

TEST(ClosingWarnings, SayThatSearchesEndedUndecided) {
  EXPECT_EQ(closing_warnings(run_of({core::UndecidedDecision{}, core::UndecidedDecision{}})).size(), 1u);
}

TEST(ClosingWarnings, SayNothingWhereMostReturnsAreClosed) {
  EXPECT_TRUE(closing_warnings(run_of({closure(true), solved(true), closure(false), core::UndecidedDecision{},
                                       closure(true), solved(true)}))
                  .empty());
  EXPECT_TRUE(closing_warnings(run_of({})).empty());
}

TEST(ClosingWarnings, SpeakOfTheMapAsItIsWhereItWasOnlyLocalized) {
  runs::Run run = run_of({closure(false), closure(false), closure(false)});
  run.manifest.command = "helixnav replay log --map run --localize";
  const auto texts = closing_warnings(run);
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_NE(texts[0].find("The map itself is unchanged"), std::string::npos) << texts[0];
  EXPECT_EQ(texts[0].find("twice"), std::string::npos) << texts[0];
}

TEST(ClosingWarnings, SayThatThePathIsNotSolvedOnlyOfTheLastClosing) {
  EXPECT_TRUE(closing_warnings(run_of({closure(true), solved(false), closure(true), solved(true)})).empty());
  const auto texts = closing_warnings(run_of({closure(true), solved(true), closure(true), solved(false)}));
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_NE(texts[0].find("trajectory_final.tum"), std::string::npos) << texts[0];
}

TEST(ClosingWarnings, SayThatTheDriveWasCutAndByHowMuch) {
  core::WholeMapDecision cut;
  cut.verdict = core::WholeMapDecision::Verdict::accepted;
  cut.odometry_factor = 0.0;
  cut.displaced_m = 3.5;
  core::WholeMapDecision reconciled = cut;
  reconciled.odometry_factor = 16.0;
  core::WholeMapDecision refused = cut;
  refused.verdict = core::WholeMapDecision::Verdict::refused;
  EXPECT_TRUE(closing_warnings(run_of({reconciled, closure(true), solved(true), refused})).empty());
  const auto texts = closing_warnings(run_of({cut, closure(true), solved(true)}));
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_NE(texts[0].find("up to 3.5 m apart"), std::string::npos) << texts[0];
}

}  // namespace
}  // namespace helixnav::reports
