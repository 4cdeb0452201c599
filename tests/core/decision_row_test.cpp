// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/decision_row.hpp"

#include <gtest/gtest.h>

namespace helixnav::core {
namespace {

/// One of each kind and verdict, as rows.
std::vector<DecisionRow> all_rows() {
  std::vector<DecisionRow> rows;
  for (const Decision& decision :
       {Decision(TriggerDecision{}), Decision(RollbackDecision{}), Decision(SlipDecision{}),
        Decision(LostBySlipDecision{}), Decision(MovingDecision{}), Decision(SystematicDecision{}),
        Decision(NoiseDecision{1.5, 0.5, 1.0, 1}), Decision(AttemptStarted{}), Decision(ReferenceUnusable{}),
        Decision(UndecidedDecision{}), Decision(NewGroundDecision{}), Decision(CarriedDecision{}),
        Decision(ShapeDecision{})}) {
    rows.push_back(row_of(decision));
  }
  for (const char* cause : {"found-out", "broken-off", "by-place", "no-odometry", "wrong-start"})
    rows.push_back(row_of(decision_of({"carried", cause, {}})));
  for (const char* reason : {"timed-out", "nothing-here", "abandoned", "outdone"}) {
    rows.push_back(row_of(decision_of({"search", reason, {}})));
  }
  for (const char* verdict : {"accepted", "too-few-matches", "ratio-too-low", "rival-too-good"}) {
    rows.push_back(row_of(decision_of({"constellation", verdict, {}})));
  }
  for (const char* kind : {"closure", "smoothing", "fix"}) {
    for (const char* verdict : {"accepted", "refused"}) rows.push_back(row_of(decision_of({kind, verdict, {}})));
  }
  for (const char* verdict : {"sought", "accepted", "ambiguous", "refused", "not-here"}) {
    rows.push_back(row_of(decision_of({"placed", verdict, {}})));
  }
  for (const char* verdict : {"accepted", "ambiguous", "refused", "not-here"}) {
    rows.push_back(row_of(decision_of({"whole-map", verdict, {}})));
  }
  for (const char* work : {"association", "window", "drive"}) {
    rows.push_back(row_of(decision_of({"postponed", work, {}})));
  }
  return rows;
}

TEST(DecisionRow, GoesThereAndBackForEveryKindAndVerdict) {
  double value = 1.0;
  for (DecisionRow row : all_rows()) {
    SCOPED_TRACE(row.kind + ' ' + row.verdict);
    ASSERT_FALSE(row.numbers.empty()) << "known rows have numbers";
    for (auto& [name, number] : row.numbers) number = name == "adopted" ? 1.0 : value += 1.0;
    const Decision decision = decision_of(row);
    EXPECT_FALSE(std::holds_alternative<OtherDecision>(decision));
    const DecisionRow back = row_of(decision);
    EXPECT_EQ(back.kind, row.kind);
    EXPECT_EQ(back.verdict, row.verdict);
    EXPECT_EQ(back.numbers, row.numbers);
  }
}

TEST(DecisionRow, UnderstandsTheNumberOfEarlierVersions) {
  const Decision decision = decision_of({"trigger", "started", {{"foreign_objects", 0.25}}});
  EXPECT_EQ(std::get<TriggerDecision>(decision).expected_confusers, 0.25);
}

TEST(DecisionRow, UnderstandsTheVerdictOfEarlierVersions) {
  const Decision decision = decision_of({"trigger", "rewound", {{"missing", 5}}});
  ASSERT_TRUE(std::holds_alternative<RollbackDecision>(decision));
  EXPECT_EQ(std::get<RollbackDecision>(decision).missing, 5);
  EXPECT_EQ(row_of(decision).verdict, "rolled-back");
}

TEST(DecisionRow, KeepsWhatItDoesNotKnowAsItStands) {
  const DecisionRow row{"weather", "fine", {{"temperature_c", 21.5}}};
  const DecisionRow back = row_of(decision_of(row));
  EXPECT_EQ(back.kind, row.kind);
  EXPECT_EQ(back.verdict, row.verdict);
  EXPECT_EQ(back.numbers, row.numbers);
  EXPECT_TRUE(std::holds_alternative<OtherDecision>(decision_of({"closure", "postponed", {}})));
}

}  // namespace
}  // namespace helixnav::core
