// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/reports/summary.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "run_example.hpp"

namespace helixnav::reports {
namespace {

TEST(Summary, HasTheKeysThatScriptsRelyOn) {
  const runs::Run run = runs::example_run(200);
  const auto summary = nlohmann::json::parse(summary_json(run, evaluation::evaluate(run)));
  EXPECT_EQ(summary["steps"], 200);
  EXPECT_EQ(summary["closures"]["accepted"], 3);
  EXPECT_EQ(summary["closures"]["refused"], 2);
  EXPECT_EQ(summary["closures"]["undecided"], 0);
  EXPECT_EQ(summary["closures"]["pending"], 2.0);
  EXPECT_EQ(summary["landmarks"]["mature"], 2);
  EXPECT_EQ(summary["landmarks"]["tentative"], 1);
  EXPECT_EQ(summary["chi2"], 12.5);
  EXPECT_EQ(summary["timing"]["median_us"], 12.3);
  EXPECT_EQ(summary["timing"]["total_s"], 12.3);
  EXPECT_LT(summary["error"]["rmse_m"], 1e-12);
  EXPECT_EQ(summary["error"]["fixes_used"], 200);
  EXPECT_EQ(summary["error"]["fixes_left_out"], 0);
}

core::PlacedDecision placing(core::PlacedDecision::Verdict verdict, int question, double nats) {
  core::PlacedDecision placed;
  placed.verdict = verdict;
  placed.questions = question;
  placed.pairs = 10;
  placed.evidence = placed.lead = nats;
  placed.needed = 15.0;
  return placed;
}

TEST(Summary, KeepsAPlaceThatWasFoundWhateverIsAskedOfOtherPartsAfterThat) {
  using Verdict = core::PlacedDecision::Verdict;
  runs::Run run = runs::example_run(200);
  const auto placed = [&run] {
    return nlohmann::json::parse(summary_json(run, evaluation::evaluate(run))).at("placed");
  };
  run.steps[0].decisions = {core::PlacedDecision{}};
  run.steps[10].decisions = {placing(Verdict::accepted, 1, 30.0)};
  run.steps[20].decisions = {placing(Verdict::not_here, 2, 0.0)};
  EXPECT_EQ(placed()["found"], true);
  EXPECT_EQ(placed()["last"], "accepted");
  EXPECT_EQ(placed()["questions"], 1);
  run.steps[30].decisions = {core::CarriedDecision{}};
  EXPECT_EQ(placed()["found"], false) << "of the part that the run ends in";
  EXPECT_EQ(placed()["last"], "sought");
  run.steps[40].decisions = {placing(Verdict::ambiguous, 1, 8.0)};
  EXPECT_EQ(placed()["last"], "ambiguous");
  EXPECT_EQ(placed()["best"]["lead"], 8.0) << "what was accepted before it was carried is no best answer";
}

TEST(Summary, OfASmootherThatRanAloneJudgesItsOptimum) {
  const auto rmse_m = [](bool alone) {
    runs::RunRecorder recorder("run", {}, runs::example_recording(30));
    runs::SmoothedRun smoothed;
    smoothed.alone = alone;
    for (std::int64_t k = 0; k < 30; ++k) {
      core::StepReport start = runs::example_step(k);
      smoothed.poses.push_back(start.pose.mean);  // the truth
      start.pose.mean.x_m += 3.0;
      recorder.add(start, 0.0);
    }
    runs::Run run = recorder.finish(runs::example_map());
    runs::add_smoothed(run, smoothed);
    return evaluation::evaluate(run).position->error_m.rmse;
  };
  EXPECT_NEAR(rmse_m(true), 0.0, 1e-12);
  EXPECT_NEAR(rmse_m(false), 3.0, 1e-9) << "after a filter the steps are the filter's";
}

}  // namespace
}  // namespace helixnav::reports
