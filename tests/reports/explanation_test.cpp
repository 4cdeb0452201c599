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

TEST(Explanation, OfARunWithoutLandmarksSaysWhatTheReportWarnsOf) {
  runs::Run run = run_of(10);
  EXPECT_TRUE(says(run, "Warning: the map has no landmark")) << explain_run(run);
  for (core::StepReport& step : run.steps) step.associations.clear();
  EXPECT_TRUE(says(run, "Warning: the scans hold no detections: nothing was mapped")) << explain_run(run);
  EXPECT_FALSE(says(run, "every scan was associated at once")) << explain_run(run);
  run.steps.clear();
  EXPECT_EQ(explain_run(run), "0 steps: no scan came in: there is neither a path nor a map.\n");
}

TEST(Explanation, SaysOfALocalisedRunThatTheMapStays) {
  runs::Run run = run_of(10);
  run.manifest.command = "helixnav replay log --map monday --localize";
  EXPECT_FALSE(says(run, "every scan was associated at once")) << explain_run(run);
  EXPECT_TRUE(says(run, "what fits none of its landmarks is rejected")) << explain_run(run);
  core::CarriedDecision carried;
  carried.cause = core::CarriedDecision::Cause::wrong_start;
  run.steps[3].decisions = {carried};
  EXPECT_TRUE(says(run, "The start differs from the one given")) << explain_run(run);
  EXPECT_FALSE(says(run, "event lost")) << explain_run(run);
}

TEST(Explanation, SaysThatAPlaceWasWrong) {
  runs::Run run = run_of(10);
  core::CarriedDecision carried;
  carried.cause = core::CarriedDecision::Cause::wrong_place;
  carried.part = 2;
  run.steps[3].decisions = {carried};
  run.steps[3].merged = {{5, 5}};  // exists again
  EXPECT_TRUE(says(run, "The place that was found on another map is wrong")) << explain_run(run);
  EXPECT_FALSE(says(run, "5 into 5")) << explain_run(run);
}

TEST(Explanation, SaysOfEachPartThatItWasFound) {
  runs::Run run = run_of(40);
  core::PlacedDecision placed;
  placed.verdict = core::PlacedDecision::Verdict::accepted;
  for (const std::size_t k : {5u, 20u}) run.steps[k].decisions = {core::CarriedDecision()};
  for (const std::size_t k : {10u, 30u}) run.steps[k].decisions = {placed};
  EXPECT_TRUE(says(run, "step 10 (0 s)  Found its place")) << explain_run(run);
  EXPECT_TRUE(says(run, "step 30 (0 s)  Found its place")) << explain_run(run);
}

TEST(Explanation, TellsOfNamesWhatIsSoOfThem) {
  runs::Run run = run_of(2);
  run.steps[0].associations[0] = {0, core::Outcome::augmented, 7, 0.0, 0, 0.0};
  run.names[7] = "oak";
  const std::string said = explain_step(run, 0);
  EXPECT_NE(said.find("Observation 0 began landmark 7 ('oak'): its name was new"), std::string::npos) << said;
  EXPECT_EQ(said.find("too near one to be new"), std::string::npos) << said;
  EXPECT_NE(said.find("waits: its landmark has not been seen from places far enough apart"), std::string::npos) << said;
}

TEST(Explanation, SaysOfAClosingThatTheShapeOfTheDriveDecidedIt) {
  runs::Run run = run_of(10);
  core::ShapeDecision shape;
  shape.places = 3;
  shape.pairs = 41;
  shape.rival_chi2 = 812.0;
  core::ClosureDecision closure;
  closure.accepted = true;
  closure.pairs = 41;
  closure.dof = 82;
  run.steps[7].decisions = {core::VerificationDecision(), shape, closure};
  EXPECT_TRUE(says(run, "look alike at 3 places")) << explain_run(run);
  EXPECT_TRUE(says(run, "41 landmarks mapped since the search began match old ones")) << explain_run(run);
  EXPECT_TRUE(says(run, "χ² is 812")) << explain_run(run);
}

TEST(Explanation, SaysWhatSlippedAndWhatMovesBesideASearch) {
  runs::Run run = run_of(40);
  core::SlipDecision slip;
  slip.moved_m = 0.5;
  run.steps[3].decisions = {slip, core::MovingDecision{2, 13.0, 1.5}};
  EXPECT_TRUE(says(run, "No return was ambiguous enough for a search")) << explain_run(run);
  EXPECT_TRUE(says(run, "Slips that the odometry did not show, 1:\n  step 3 (0 s)  The vehicle slipped"));
  EXPECT_TRUE(says(run, "What moves, 1:\n  step 3 (0 s)  A moving object, at 1.5 m/s")) << explain_run(run);
  run.steps[20].decisions = {core::UndecidedDecision{}};
  EXPECT_FALSE(says(run, "No return was ambiguous enough for a search"));
  EXPECT_TRUE(says(run, "Slips that the odometry did not show, 1:"));
}

TEST(Explanation, SaysWhichNoiseWasLearnt) {
  runs::Run run = run_of(40);
  run.steps[3].decisions = {core::NoiseDecision{1.5, 0.5, 1.0, 1}};
  EXPECT_TRUE(
      says(run,
           "Noise that was learnt, 1:\n  step 3 (0 s)  The drive shows other noise than was stated: odometry errs 1.5 "
           "times as much, detections err 0.5 times as much. What was driven before was solved again"))
      << explain_run(run);
  run.steps[3].decisions = {core::NoiseDecision{1.0, 1.0, 2.0, 0}};
  EXPECT_TRUE(says(run, "stated: fixes err 2 times as much. That holds from now on")) << explain_run(run);
  run.steps[3].decisions = {core::NoiseDecision{1.0, 1.0, 1.0, 1}};
  EXPECT_TRUE(says(run, "stated: none, after all.")) << explain_run(run);
}

TEST(Explanation, ListsTheFirstOfManyAndCountsTheOthers) {
  runs::Run run = run_of(12);
  for (core::StepReport& step : run.steps) step.decisions = {core::MovingDecision{1, 13.0, 1.5}};
  EXPECT_TRUE(says(run, "What moves, 12:")) << explain_run(run);
  EXPECT_TRUE(says(run, "  step 4 ("));
  EXPECT_FALSE(says(run, "  step 5 ("));
  EXPECT_TRUE(says(run, "  And 7 more in decisions.csv.\n"));
}

core::PlacedDecision answer(core::PlacedDecision::Verdict verdict, int question, double evidence, double lead) {
  core::PlacedDecision answer;
  answer.verdict = verdict;
  answer.questions = question;
  answer.landmarks = 20;
  answer.pairs = 12;
  answer.evidence = evidence;
  answer.lead = lead;
  answer.needed = 15.0;
  answer.driven_m = 100.0 * question;
  return answer;
}

TEST(Explanation, SaysHowOftenAPlaceWasAskedForAndWhatWasLacking) {
  using Verdict = core::PlacedDecision::Verdict;
  runs::Run run = run_of(6);
  run.steps[0].decisions = {core::PlacedDecision{}};
  run.steps[1].decisions = {answer(Verdict::not_here, 1, 8.0, 8.0)};
  run.steps[2].decisions = {answer(Verdict::ambiguous, 2, 40.0, 11.0)};
  run.steps[3].decisions = {answer(Verdict::ambiguous, 3, 40.0, 3.0)};
  const std::string text = explain_run(run);
  EXPECT_NE(text.find("step 2 ("), std::string::npos);
  EXPECT_EQ(text.find("step 3 ("), std::string::npos) << "says the same as the one before\n" << text;
  EXPECT_TRUE(says(run, "3 questions were asked, from 100 to 300 m.")) << text;
  EXPECT_TRUE(
      says(run, "Closest to an answer was question 2 after 200 m, with 20 landmarks around the vehicle: 12 of them"))
      << text;
  EXPECT_TRUE(says(run, "evidence of 40 nats and a lead over other places of 11 nats (15 are needed).")) << text;
  EXPECT_TRUE(says(run, "The last was question 3 after 300 m")) << text;
  run.steps[4].decisions = {answer(Verdict::accepted, 4, 40.0, 20.0)};
  EXPECT_FALSE(says(run, "questions were asked")) << "it is told by what was found";
}

TEST(Explanation, SaysThatThereWasTooLittleToAskWith) {
  runs::Run run = run_of(2);
  core::PlacedDecision few;
  few.landmarks = 5;
  run.steps[0].decisions = {core::PlacedDecision{}, few};
  EXPECT_TRUE(says(run, "No question was asked: never more than 5 landmarks")) << explain_run(run);
}

}  // namespace
}  // namespace helixnav::reports
