// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "helixnav/core/decision_row.hpp"
#include "helixnav/reports/decision_sentence.hpp"
#include "helixnav/reports/explanation.hpp"
#include "helixnav/reports/run_warnings.hpp"
#include "helixnav/reports/summary.hpp"
#include "report/report_opening.hpp"

namespace helixnav::reports {
namespace {

/// Along x at 1 m a second, with an error of `drift_m` in y that a closing in scan 60 removes.
runs::Run drifting_run(double drift_m) {
  runs::Run run;
  for (int k = 0; k < 120; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.step = k;
    step.t_ns = k * 1'000'000'000LL;
    step.pose.mean = {1.0 * k, k < 60 ? drift_m : 0.25, 0.0};
    step.associations = {{0, core::Outcome::matched, 1, 1.0, 2, 1.0}};
    run.truth.poses.push_back({step.t_ns, {1.0 * k, 0.0, 0.0}});
  }
  core::ClosureDecision closure;
  closure.accepted = true;
  run.steps[60].decisions = {closure};
  core::MapLandmark landmark;
  landmark.state = core::LandmarkState::mature;
  run.map = {landmark};
  return run;
}

std::string all_of(const Json& texts) {
  std::string all;
  for (const Json& text : texts) all += text.get<std::string>() + '\n';
  return all;
}

TEST(Opening, SaysWhatWasDrivenAndClosedAndHowWrongItWas) {
  runs::Run run = drifting_run(4.0);
  run.final_path.assign(run.steps.size(), {});
  for (std::size_t k = 0; k < run.final_path.size(); ++k) run.final_path[k] = {1.0 * static_cast<double>(k), 0.5, 0.0};
  const std::string said = all_of(opening_data(run, evaluation::evaluate(run))["sentences"]);
  EXPECT_NE(said.find("120 scans, and a map of 1 landmark."), std::string::npos) << said;
  EXPECT_NE(said.find("The map was closed once; no closing was refused."), std::string::npos) << said;
  EXPECT_NE(said.find("4 m at most; of the path as corrected since: 0.5 m RMSE"), std::string::npos) << said;
}

/// Two landmarks are begun in scan 0 and one of them is matched in scan 1; then one is begun in every scan.
runs::Run run_without_landmarks(int steps) {
  runs::Run run = drifting_run(0.0);
  run.steps.resize(static_cast<std::size_t>(steps));
  run.map.clear();
  core::LandmarkId next = 1;
  for (core::StepReport& step : run.steps) {
    step.decisions.clear();
    step.associations = {{0, core::Outcome::augmented, next, 1.0, 2, 1.0}};
    ++next;
  }
  if (steps > 1) run.steps[1].associations.push_back({1, core::Outcome::matched, 1, 1.0, 2, 1.0});
  return run;
}

TEST(Opening, WarnsOfAMapWithoutLandmarksOnlyAfterScansEnoughToTell) {
  for (const int steps : {1, 2, 9}) {
    const runs::Run run = run_without_landmarks(steps);
    EXPECT_EQ(nothing_mapped_text(run), "") << steps;
  }
  const std::string text = nothing_mapped_text(run_without_landmarks(10));
  EXPECT_NE(text.find("of 11 detections 1 were matched, and 9 of the 10 landmarks begun were never seen again."),
            std::string::npos)
      << text;
}

TEST(Opening, OfASingleScanSpeaksOfNoWay) {
  const runs::Run run = run_without_landmarks(1);
  const std::string said = all_of(opening_data(run, evaluation::evaluate(run))["sentences"]);
  EXPECT_NE(said.find("A single scan was taken, and a map of 0 landmarks."), std::string::npos) << said;
  EXPECT_EQ(said.find("drove"), std::string::npos) << said;
}

TEST(Opening, SaysHowOftenTheVehicleSlipped) {
  runs::Run run = drifting_run(0.0);
  const auto said = [&run] { return all_of(opening_data(run, evaluation::evaluate(run))["sentences"]); };
  EXPECT_EQ(said().find("slipped"), std::string::npos);
  core::SlipDecision slip;
  slip.moved_m = 0.5;
  run.steps[20].decisions = {slip};
  EXPECT_NE(said().find("The vehicle slipped once, by 0.5 m, at 20 s, and its"), std::string::npos) << said();
  slip.moved_m = 0.75;
  run.steps[40].decisions = {slip};
  EXPECT_NE(said().find("The vehicle slipped twice, by 0.75 m at most, at 40 s, and its"), std::string::npos) << said();
}

TEST(Opening, SaysHowOftenSomethingThatMovesHadBeenMapped) {
  runs::Run run = drifting_run(0.0);
  const auto said = [&run] { return all_of(opening_data(run, evaluation::evaluate(run))["sentences"]); };
  EXPECT_EQ(said().find("moves"), std::string::npos);
  run.steps[20].decisions = {core::MovingDecision{2, 13.0, 1.5}};
  EXPECT_NE(said().find("A moving object had been mapped once: 2 landmarks were dropped."), std::string::npos);
  run.steps[40].decisions = {core::MovingDecision{1, 13.0, 1.5}};
  EXPECT_NE(said().find("mapped twice: 3 landmarks were dropped."), std::string::npos) << said();
}

TEST(Opening, SaysHowOftenTheVehicleWasCarriedAndFoundItsPlaceAgain) {
  runs::Run run = drifting_run(0.0);
  const auto said = [&run] { return all_of(opening_data(run, evaluation::evaluate(run))["sentences"]); };
  core::PlacedDecision placed;
  placed.verdict = core::PlacedDecision::Verdict::accepted;
  placed.driven_m = 1234.5;
  run.steps[10].decisions = {placed};
  EXPECT_NE(said().find("It found its place on the earlier map after 1.23 km."), std::string::npos) << said();
  run.steps[20].decisions = {core::CarriedDecision{}};
  EXPECT_NE(said().find("The vehicle was carried once; afterwards its place on the map from before was never found."),
            std::string::npos)
      << said();
  run.steps[30].decisions = {placed};
  EXPECT_NE(said().find("before was found."), std::string::npos) << said();
  run.steps[40].decisions = {core::CarriedDecision{}};
  EXPECT_NE(said().find("carried twice; afterwards its place on the map from before was found once."),
            std::string::npos)
      << said();
}

TEST(Opening, SaysThatAPlaceWasWrongAndNotThatTheVehicleWasCarried) {
  runs::Run run = drifting_run(0.0);
  core::PlacedDecision placed;
  placed.verdict = core::PlacedDecision::Verdict::accepted;
  placed.driven_m = 12.0;
  core::CarriedDecision again;
  again.cause = core::CarriedDecision::Cause::wrong_place;
  run.steps[10].decisions = {placed};
  placed.driven_m = 50.0;
  run.steps[50].decisions = {again, placed};
  const std::string said = all_of(opening_data(run, evaluation::evaluate(run))["sentences"]);
  EXPECT_NE(said.find("It found its place on the earlier map after 50 m. A place found before was wrong."),
            std::string::npos)
      << said;
  EXPECT_EQ(said.find("carried"), std::string::npos) << said;
}

TEST(Opening, SaysThatAStartWasWrongAndNotThatTheVehicleWasCarried) {
  runs::Run run = drifting_run(0.0);
  core::CarriedDecision wrong;
  wrong.cause = core::CarriedDecision::Cause::wrong_start;
  wrong.part = 1;
  wrong.scans = 5;
  core::PlacedDecision placed;
  placed.verdict = core::PlacedDecision::Verdict::accepted;
  placed.part = 0;
  placed.driven_m = 12.0;
  placed.T_map_session = {40.0, 0.0, 0.0};
  run.steps[10].decisions = {wrong, placed};
  run.warnings = {"the start given (--start) is wrong"};
  const auto data = [&run] { return opening_data(run, evaluation::evaluate(run)); };
  EXPECT_NE(
      all_of(data()["sentences"])
          .find("The start given on the earlier map was wrong. It found its place on the earlier map after 12 m."),
      std::string::npos)
      << all_of(data()["sentences"]);
  EXPECT_NE(all_of(data()["sentences"]).find("5 scans were reported at another place at the time, up to 40 m"),
            std::string::npos)
      << all_of(data()["sentences"]);
  EXPECT_EQ(all_of(data()["sentences"]).find("carried"), std::string::npos);
  EXPECT_NE(all_of(data()["warnings"]).find("(--start) is wrong"), std::string::npos);
  run.steps[10].decisions = {wrong};
  EXPECT_NE(all_of(data()["sentences"]).find("was wrong, and the place was not found."), std::string::npos)
      << all_of(data()["sentences"]);
}

TEST(Opening, WritesNoPowersOfTen) {
  EXPECT_EQ(short_number(1617.25), "1617");
  EXPECT_EQ(short_number(314.6), "315");
  EXPECT_EQ(short_number(31.46), "31.5");
}

TEST(Opening, OfACloudOfParticlesSpeaksOfNoSearch) {
  runs::Run run = drifting_run(0.0);
  for (core::StepReport& step : run.steps) {
    step.decisions.clear();
    step.particles = core::CloudReport{100, 40.0, false, 0.0, 9};
  }
  const std::string said = all_of(opening_data(run, evaluation::evaluate(run))["sentences"]);
  EXPECT_NE(said.find("cloud of particles"), std::string::npos) << said;
  EXPECT_EQ(said.find("No search"), std::string::npos) << said;
}

TEST(Opening, CountsLongDrivesInHours) {
  runs::Run run = drifting_run(0.0);
  run.steps.back().t_ns = 19'980'000'000'000LL;
  const std::string said = all_of(opening_data(run, evaluation::evaluate(run))["sentences"]);
  EXPECT_NE(said.find(" in 5 h 33 min: "), std::string::npos) << said;
}

TEST(Opening, KnowsTheErrorBeforeAndAfterAClosing) {
  const runs::Run run = drifting_run(4.0);
  const ErrorAround error = error_around(run, 60, evaluation::evaluate(run));
  EXPECT_DOUBLE_EQ(error.before_m.value(), 4.0);
  EXPECT_DOUBLE_EQ(error.after_m.value(), 0.25);
}

TEST(Opening, KnowsNoErrorWithoutTruthNearby) {
  runs::Run run = drifting_run(4.0);
  run.truth.poses.resize(20);  // ends 40 s before the closing
  const ErrorAround error = error_around(run, 60, evaluation::evaluate(run));
  EXPECT_FALSE(error.before_m);
  EXPECT_FALSE(error.after_m);
  run.truth.poses.clear();
  EXPECT_FALSE(error_around(run, 60, evaluation::evaluate(run)).before_m);
  EXPECT_NE(all_of(opening_data(run, evaluation::evaluate(run))["sentences"]).find("No truth is known"),
            std::string::npos);
}

TEST(Opening, WarnsOfALongDriveWithoutAMatchAndOfASearchLeftOpen) {
  runs::Run run = drifting_run(0.0);
  EXPECT_TRUE(warnings_of_place(run).empty());
  for (std::size_t k = 10; k < 115; ++k) run.steps[k].associations.clear();
  run.steps.back().mode = core::Mode::searching;
  const std::vector<std::string> warnings = warnings_of_place(run);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("105 scans in a row, from 10 s on"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("still open"), std::string::npos) << warnings[1];
}

TEST(Opening, SaysThatThePlaceOnTheMapWasNotFoundAndHowNearItCame) {
  runs::Run run = drifting_run(0.0);
  EXPECT_TRUE(place_not_found_text(run).empty());
  core::PlacedDecision asked;
  run.steps[0].decisions = {asked};
  EXPECT_NE(place_not_found_text(run).find("never found its place on the earlier map"), std::string::npos);
  EXPECT_NE(place_not_found_text(run).find("no question was asked"), std::string::npos) << place_not_found_text(run);
  asked.verdict = core::PlacedDecision::Verdict::ambiguous;
  asked.questions = 5;
  asked.landmarks = asked.pairs = 24;
  asked.evidence = 159.0;
  asked.lead = 7.0;
  asked.needed = 15.0;
  run.steps[20].decisions = {asked};
  const std::string text = place_not_found_text(run);
  EXPECT_NE(text.find("closest to an answer was question 5"), std::string::npos) << text;
  EXPECT_NE(text.find("a lead over other places of 7 nats (15 are needed)"), std::string::npos) << text;
  const std::string against = evaluation_text(evaluation::evaluate(run));
  EXPECT_NE(against.find("since the session began: its place on the earlier map was not found"), std::string::npos)
      << against;
  run.steps[30].decisions = {core::CarriedDecision{}};
  EXPECT_NE(place_not_found_text(run).find("since it was carried"), std::string::npos) << place_not_found_text(run);
  asked.verdict = core::PlacedDecision::Verdict::accepted;
  run.steps[40].decisions = {asked};
  EXPECT_TRUE(place_not_found_text(run).empty());
}

TEST(Opening, DoesNotBlameTheOdometryOfWhoOnlyLocalisesAndWasNotPlaced) {
  runs::Run run = drifting_run(0.0);
  for (core::StepReport& step : run.steps) {
    step.associations.assign(3, {0, core::Outcome::rejected});
    step.decisions.clear();
  }
  const auto says = [&run](const char* words) {
    return all_of(warnings_of(run, evaluation::evaluate(run))).find(words) != std::string::npos;
  };
  EXPECT_TRUE(says("matching collapsed"));
  run.steps[0].decisions = {core::PlacedDecision{}};
  run.manifest.command = "helixnav replay log --map monday --localize";
  EXPECT_FALSE(says("matching collapsed"));
}

TEST(Opening, WarnsWhereTheWholeMapHasAnotherPlaceAgainAndAgain) {
  runs::Run run = drifting_run(0.0);
  run.steps[60].decisions.clear();  // nothing is closed
  core::WholeMapDecision asked;
  asked.verdict = core::WholeMapDecision::Verdict::refused;
  asked.lead = 60.0;
  asked.needed = 25.0;
  asked.displaced_m = 317.0;
  for (const std::size_t k : {10u, 20u}) run.steps[k].decisions.emplace_back(asked);
  EXPECT_TRUE(contradicted_place_text(run).empty()) << "twice: of a bent map";
  run.steps[30].decisions.emplace_back(asked);
  EXPECT_NE(contradicted_place_text(run).find("317 m"), std::string::npos) << contradicted_place_text(run);
  EXPECT_NE(contradicted_place_text(run).find("helixnav calibrate"), std::string::npos) << "no start was given";
  EXPECT_EQ(contradicted_place_text(run).find("--start"), std::string::npos) << contradicted_place_text(run);
  run.manifest.command = "helixnav replay log --map monday --start end";
  const std::vector<std::string> warnings = warnings_of(run, evaluation::evaluate(run));
  const std::string all = warnings.empty() ? "" : warnings.back();
  EXPECT_NE(all.find("--start unknown"), std::string::npos) << all;
  EXPECT_NE(explain_run(run).find("--start unknown"), std::string::npos);
  core::PlacedDecision placed;
  placed.verdict = core::PlacedDecision::Verdict::accepted;
  run.steps[5].decisions.emplace_back(placed);
  EXPECT_NE(contradicted_place_text(run).find("helixnav join"), std::string::npos) << "the start was not given";
  EXPECT_EQ(contradicted_place_text(run).find("--start"), std::string::npos) << contradicted_place_text(run);
  for (core::StepReport& step : run.steps) step.pose.covariance = 0.0009 * Eigen::Matrix3d::Identity();
  asked.displaced_m = 0.04;
  for (const std::size_t k : {10u, 20u}) run.steps[k].decisions.back() = asked;
  EXPECT_TRUE(contradicted_place_text(run).empty()) << "where it is believed to be";
  asked.displaced_m = 317.0;
  asked.lead = 20.0;
  for (const std::size_t k : {10u, 20u}) run.steps[k].decisions.back() = asked;
  EXPECT_TRUE(contradicted_place_text(run).empty()) << "not sure of the place";
  asked.lead = 60.0;
  for (const std::size_t k : {10u, 20u}) run.steps[k].decisions.back() = asked;
  asked.verdict = core::WholeMapDecision::Verdict::accepted;
  run.steps[40].decisions.emplace_back(asked);
  EXPECT_TRUE(contradicted_place_text(run).empty()) << "found at last";
  core::ClosureDecision closed;
  closed.accepted = true;
  run.steps[40].decisions = {closed};
  EXPECT_TRUE(contradicted_place_text(run).empty()) << "closed at last";
}

TEST(Opening, WarnsWhereTheWholeMapHasAnotherPlaceOnceThatNoBentMapExplains) {
  runs::Run run = drifting_run(0.0);
  run.steps[60].decisions.clear();
  core::WholeMapDecision asked;
  asked.verdict = core::WholeMapDecision::Verdict::refused;
  asked.lead = 60.0;
  asked.needed = 25.0;
  asked.displaced_m = 317.0;
  asked.limit = 29.0;
  asked.cost = 200.0;
  run.steps[10].decisions = {asked};
  EXPECT_TRUE(contradicted_place_text(run).empty());
  asked.cost = 5000.0;
  run.steps[10].decisions = {asked};
  EXPECT_NE(contradicted_place_text(run).find("317 m"), std::string::npos);
}

std::string all_warnings(const runs::Run& run) {
  std::string all;
  for (const std::string& text : warnings_of(run, evaluation::evaluate(run))) all += text + '\n';
  return all;
}

TEST(Opening, WarnsWhereOdometryAndWhatIsSeenContradictEachOtherAllAlong) {
  runs::Run slipping = drifting_run(0.0);
  for (std::size_t k = 0; k < 9; ++k) slipping.steps[10 * k].decisions.emplace_back(core::SlipDecision());
  EXPECT_EQ(all_warnings(slipping).find("helixnav calibrate"), std::string::npos) << "wheels do slip";
  slipping.steps[95].decisions.emplace_back(core::SlipDecision());
  EXPECT_NE(all_warnings(slipping).find("seems to have slipped in 10 of"), std::string::npos) << all_warnings(slipping);
  runs::Run rejecting = drifting_run(0.0);
  core::AssociationReport rejected;
  rejected.outcome = core::Outcome::rejected;
  rejected.landmark = core::no_landmark;
  for (std::size_t k = 0; k < 100; ++k) rejecting.steps[k].associations.assign(4, rejected);
  EXPECT_NE(all_warnings(rejecting).find("rejected because they fit nothing"), std::string::npos)
      << all_warnings(rejecting);
  rejecting.manifest.command = "helixnav replay log --map monday --localize";
  EXPECT_EQ(all_warnings(rejecting).find("rejected because"), std::string::npos)
      << "what is not on the map given is rejected";
}

TEST(Opening, OfARunWithoutStepsSaysOnlyThatNothingCameIn) {
  const Json opening = opening_data({}, {});
  EXPECT_TRUE(opening["sentences"].empty());
  EXPECT_EQ(opening["warnings"], Json({"no scan came in: there is neither a path nor a map"}));
}

TEST(Warnings, SayThatNamedBearingsDoNotPlaceTheirLandmarks) {
  runs::Run run = drifting_run(0.0);
  run.manifest.command = "replay log --association known";
  const auto said = [&run] {
    std::string all;
    for (const std::string& text : warnings_of(run, evaluation::evaluate(run))) all += text + '\n';
    return all;
  };
  EXPECT_EQ(said(), "");
  for (core::StepReport& step : run.steps) {
    step.associations = {{0, core::Outcome::ambiguous, core::no_landmark, 0.0, 0, 0.0}};
  }
  EXPECT_NE(said().find("100 % of 120 detections are ranges or bearings of landmarks that could not be placed"),
            std::string::npos)
      << said();
}

TEST(Warnings, SayThatParticlesOfOneAncestorDoNotKnowHowWrongTheyAre) {
  runs::Run run = drifting_run(0.0);
  core::CloudReport cloud;
  cloud.hypotheses = 100;
  cloud.effective_size = 80.0;
  cloud.distinct_ancestors = 40;
  for (core::StepReport& step : run.steps) step.particles = cloud;
  EXPECT_TRUE(warnings_of(run, evaluation::evaluate(run)).empty());
  run.steps[90].particles->distinct_ancestors = 1;
  const std::vector<std::string> warnings = warnings_of(run, evaluation::evaluate(run));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("descend from 1 of those a loop's length ago"), std::string::npos) << warnings[0];
}

}  // namespace
}  // namespace helixnav::reports
