// SPDX-License-Identifier: BSD-3-Clause
#include "numerics_text.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "helixnav/reports/explanation.hpp"
#include "helixnav/reports/run_warnings.hpp"
#include "helixnav/reports/summary.hpp"
#include "run_example.hpp"

namespace helixnav::reports {
namespace {

runs::Run run_of(const core::NumericalHealth& numerics, const std::vector<core::Decision>& decisions = {}) {
  runs::RunRecorder recorder("run", {}, runs::example_recording(30));
  for (std::int64_t k = 0; k < 30; ++k) {
    core::StepReport step = runs::example_step(k);
    step.numerics = k == 20 ? numerics : core::NumericalHealth{};
    if (k == 20) step.decisions = decisions;
    recorder.add(step, 0.0);
  }
  return recorder.finish(runs::example_map());
}

std::vector<std::string> warnings_about(const runs::Run& run) { return warnings_of(run, evaluation::evaluate(run)); }

bool has(const std::string& text, const char* words) { return text.find(words) != std::string::npos; }

TEST(Numerics, AreAddedUpInTheSummary) {
  const runs::Run run = runs::example_run(200);
  const auto summary = nlohmann::json::parse(summary_json(run, evaluation::evaluate(run)));
  EXPECT_EQ(summary["numerics"]["least_pivot"], 1.0 / 202.0);
  EXPECT_EQ(summary["numerics"]["asymmetry"], 1e-17 / 3.0);
  EXPECT_EQ(summary["numerics"]["repaired"], 3);
  EXPECT_EQ(summary["numerics"]["refused"], 6);
  EXPECT_FALSE(summary.contains("postponed"));
}

TEST(Numerics, OfAHealthyRunAreSaidWhereOneAsksAndNoWarning) {
  const runs::Run run = run_of({0.25, 1e-16, 0, 0});
  for (const std::string& text : warnings_about(run)) EXPECT_FALSE(has(text, "mathematics") || has(text, "limit"));
  EXPECT_TRUE(has(explain_run(run),
                  "nothing was repaired or refused; the least pivot of an innovation covariance was "
                  "0.25"))
      << explain_run(run);
}

TEST(Numerics, ThatWereRepairedRefusedOrNearTheirLimitAreAWarning) {
  const runs::Run run = run_of({1e-13, 1e-16, 1, 2});
  const std::vector<std::string> warnings = warnings_about(run);
  ASSERT_FALSE(warnings.empty());
  EXPECT_TRUE(has(warnings.back(), "1 were done in another way (nothing is lost by it) and 2 were left undone"))
      << warnings.back();
  EXPECT_TRUE(has(warnings.back(), "near its limit")) << warnings.back();
  EXPECT_TRUE(has(explain_run(run), warnings.back().c_str()));
  EXPECT_TRUE(has(explain_step(run, 20), warnings.back().c_str()));
  EXPECT_FALSE(has(explain_step(run, 19), "near its limit"));
}

TEST(Numerics, WorkThatWasLeftOutIsCountedAndSaid) {
  using Work = core::PostponedDecision::Work;
  const runs::Run run = run_of({}, {core::PostponedDecision{Work::window, 900.0, 400.0},
                                    core::PostponedDecision{Work::association, 12.0, 30000.0}});
  const auto summary = nlohmann::json::parse(summary_json(run, evaluation::evaluate(run)));
  EXPECT_EQ(summary["postponed"]["windows"], 1);
  EXPECT_EQ(summary["postponed"]["associations"], 1);
  EXPECT_EQ(summary["postponed"]["drives"], 0);
  EXPECT_TRUE(has(warnings_about(run).back(), "work was left out or put off")) << warnings_about(run).back();
  EXPECT_TRUE(has(explain_step(run, 20), "after 30000 hypotheses")) << explain_step(run, 20);
}

// A receiver's outliers are a few in a hundred; if the gate refuses more, the fixes' stated accuracy is wrong.
TEST(Fixes, ThatAreMostlyRefusedAreAWarning) {
  const auto said = [](int used, int refused) {
    std::vector<core::Decision> decisions;
    for (int k = 0; k < used + refused; ++k) {
      core::FixDecision fix;
      fix.accepted = k < used;
      decisions.emplace_back(fix);
    }
    const std::vector<std::string> warnings = warnings_about(run_of({}, decisions));
    return std::count_if(warnings.begin(), warnings.end(),
                         [](const std::string& text) { return has(text, "position fixes were refused"); });
  };
  EXPECT_EQ(said(15, 10), 1);
  EXPECT_EQ(said(95, 5), 0);
  EXPECT_EQ(said(0, 10), 0) << "too few to say";
}

TEST(Fixes, ThatWereFoundToErrAlikeAreAWarning) {
  const auto said = [](double widened) {
    core::FixDecision fix;
    fix.accepted = true;
    fix.widened = widened;
    const std::vector<std::string> warnings = warnings_about(run_of({}, {core::FixDecision{}, fix}));
    return std::count_if(warnings.begin(), warnings.end(),
                         [](const std::string& text) { return has(text, "used with 12.0 times"); });
  };
  EXPECT_EQ(said(144.0), 1);
  EXPECT_EQ(said(2.0), 0);
}

}  // namespace
}  // namespace helixnav::reports
