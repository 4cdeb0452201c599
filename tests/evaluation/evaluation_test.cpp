// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/evaluation/evaluation.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "helixnav/core/chi2.hpp"
#include "helixnav/reports/summary.hpp"
#include "run_interpolation.hpp"

namespace helixnav::evaluation {
namespace {

core::StepReport step_at(std::int64_t index, double t_s, const core::Pose2& pose) {
  core::StepReport step;
  step.step = index;
  step.t_ns = core::nanoseconds_from_seconds(t_s);
  step.pose.mean = pose;
  step.pose.covariance = Eigen::Vector3d(0.04, 0.09, 0.01).asDiagonal();
  return step;
}

// Straight along x at 1 m/s for 10 s.
runs::Run straight_run() {
  runs::Run run;
  for (int k = 0; k <= 10; ++k) run.steps.push_back(step_at(k, k, core::Pose2(k, 0.0, 0.0)));
  return run;
}

TEST(ErrorStatistics, EqualHandComputedValues) {
  const ErrorStatistics statistics = error_statistics({4.0, 0.0, 2.0, 1.0, 3.0});
  EXPECT_EQ(statistics.count, 5u);
  EXPECT_DOUBLE_EQ(statistics.rmse, std::sqrt(30.0 / 5.0));
  EXPECT_DOUBLE_EQ(statistics.median, 2.0);
  EXPECT_DOUBLE_EQ(statistics.p95, 3.8);  // place 0.95·4 = 3.8 between 3 and 4
  EXPECT_DOUBLE_EQ(statistics.max, 4.0);
  EXPECT_TRUE(std::isnan(error_statistics({}).rmse));
}

TEST(Interpolation, IsSilentOutsideTheRunAndExactAtItsSteps) {
  const runs::Run run = straight_run();
  EXPECT_FALSE(estimate_at(run.steps, -1));
  EXPECT_FALSE(estimate_at(run.steps, 10'000'000'001));
  EXPECT_EQ(estimate_at(run.steps, 10'000'000'000)->mean.x_m, 10.0);
  EXPECT_NEAR(estimate_at(run.steps, 2'250'000'000)->mean.x_m, 2.25, 1e-12);
}

TEST(Evaluation, AlignsTheAntennaAndLeavesFarFixesOut) {
  runs::Run run;  // a square, so that the alignment is well conditioned
  const core::Pose2 corners[] = {{0, 0, 0}, {40, 0, core::pi / 2}, {40, 40, core::pi}, {0, 40, -core::pi / 2}};
  for (int k = 0; k < 40; ++k) run.steps.push_back(step_at(k, k, corners[k % 4]));
  const core::Pose2 T_truth_map(500.0, -20.0, 1.0);
  run.truth.antenna_robot_m = {3.78, 0.5};
  for (int k = 0; k < 40; ++k) {
    const Eigen::Vector2d antenna = core::transform(corners[k % 4], run.truth.antenna_robot_m);
    run.truth.positions.push_back({run.steps[static_cast<std::size_t>(k)].t_ns, core::transform(T_truth_map, antenna)});
  }
  run.truth.positions[5].position_m.x() += 300.0;
  run.truth.positions.push_back({core::nanoseconds_from_seconds(99.0), {0.0, 0.0}});
  const Evaluation evaluation = evaluate(run);
  ASSERT_TRUE(evaluation.position);
  EXPECT_TRUE(evaluation.position->aligned);
  EXPECT_EQ(evaluation.position->fixes_used, 39u);
  EXPECT_EQ(evaluation.position->fixes_left_out, 1u);
  EXPECT_EQ(evaluation.position->fixes_outside, 1u);
  EXPECT_LT(evaluation.position->error_m.max, 1e-9);
  EXPECT_NEAR(evaluation.position->T_truth_map.x_m, 500.0, 1e-9);
  EXPECT_FALSE(evaluation.position->errors[5].used);
  EXPECT_FALSE(evaluation.pose);
}

TEST(Evaluation, AgainstTruePosesEqualsHandComputedValues) {
  runs::Run run = straight_run();
  for (int k = 0; k <= 10; ++k) {  // estimate − truth = (−0.2, −0.3, −0.1): one sigma in each coordinate
    run.truth.poses.push_back({run.steps[static_cast<std::size_t>(k)].t_ns, core::Pose2(k + 0.2, 0.3, 0.1)});
  }
  run.truth.poses[10].T_world_robot = core::Pose2(10.0, 0.0, -0.1);  // (0, 0, +0.1)
  const Evaluation evaluation = evaluate(run);
  EXPECT_FALSE(evaluation.position->aligned);
  EXPECT_NEAR(evaluation.position->error_m.rmse, std::sqrt(10.0 * 0.13 / 11.0), 1e-12);
  EXPECT_NEAR(evaluation.position->error_m.median, std::sqrt(0.13), 1e-12);
  EXPECT_NEAR(evaluation.position->errors[0].error_m.x(), -0.2, 1e-12);
  EXPECT_NEAR(evaluation.pose->heading_error_rad.rmse, 0.1, 1e-12);
  EXPECT_NEAR(evaluation.pose->errors[10].error_rad, 0.1, 1e-12);
  EXPECT_NEAR(evaluation.pose->errors[0].nees, 3.0, 1e-9);
  EXPECT_NEAR(evaluation.pose->nees_mean, 31.0 / 11.0, 1e-9);
  EXPECT_EQ(evaluation.pose->nees_inside_95, 1.0);
}

/// The vehicle turns in the second half of each second only; the estimates are right at the scans, and between them nobody knows.
TEST(Evaluation, JudgesAtTheScansWhereTheTruthIsDenser) {
  runs::Run run;
  for (int k = 0; k <= 10; ++k) run.steps.push_back(step_at(k, k, core::Pose2(k, 0.0, 0.4 * k)));
  const auto known_at = [](double t_s) {
    const double since_scan_s = t_s - std::floor(t_s);
    return core::Pose2(t_s, 0.0, 0.4 * (std::floor(t_s) + 2.0 * std::max(0.0, since_scan_s - 0.5)));
  };
  for (int i = -5; i <= 120; ++i) {
    run.truth.poses.push_back({core::nanoseconds_from_seconds(0.1 * i), known_at(0.1 * i)});
  }
  const Evaluation evaluation = evaluate(run);
  EXPECT_EQ(evaluation.position->fixes_used, 11u);
  EXPECT_EQ(evaluation.position->fixes_outside, 0u);
  EXPECT_LT(evaluation.pose->heading_error_rad.max, 1e-9);
  EXPECT_LT(evaluation.pose->nees_mean, 1e-9);
}

/// For 20 s nothing is seen while the vehicle drives round a corner: its position between the two scans is unknown.
TEST(Evaluation, LeavesOutWhatLiesInAGapBetweenScans) {
  runs::Run run = straight_run();
  for (int k = 0; k <= 10; ++k)
    run.steps.push_back(step_at(11 + k, 30.0 + k, core::Pose2(10.0, 20.0 + k, core::pi / 2.0)));
  const auto known = [&run](double t_s, const core::Pose2& pose) {
    run.truth.poses.push_back({core::nanoseconds_from_seconds(t_s), pose});
  };
  for (int k = 0; k <= 10; ++k) known(k, core::Pose2(k, 0.0, 0.0));
  known(12.5, core::Pose2(10.0, 0.0, 0.0));  // just after the last scan
  for (int k = 14; k <= 26; ++k) known(k, core::Pose2(40.0, 0.0, 0.0));
  for (int k = 30; k <= 40; ++k) known(k, core::Pose2(10.0, k - 10.0, core::pi / 2.0));
  const Evaluation evaluation = evaluate(run);
  EXPECT_EQ(evaluation.position->fixes_in_gaps, 14u);
  EXPECT_EQ(evaluation.position->gap_s, 3.0);
  EXPECT_EQ(evaluation.position->fixes_used, 22u);
  EXPECT_EQ(evaluation.position->fixes_outside, 0u);
  EXPECT_EQ(evaluation.pose->nees_count, 22u);
  EXPECT_LT(evaluation.position->error_m.max, 1e-9);
  EXPECT_NE(reports::evaluation_text(evaluation).find("14, left out: between scans farther apart than 3 s"),
            std::string::npos);
  run.truth.positions.push_back({core::nanoseconds_from_seconds(20.0), {40.0, 0.0}});
  for (int k = 0; k <= 10; ++k) run.truth.positions.push_back({core::nanoseconds_from_seconds(k), {1.0 * k, 0.0}});
  EXPECT_EQ(evaluate(run).position->fixes_in_gaps, 1u);
  EXPECT_EQ(evaluate(run).position->fixes_used, 11u);
}

TEST(Evaluation, AlignsTruePosesThatAreInAFrameOfTheirOwn) {
  runs::Run run = straight_run();
  const core::Pose2 T_truth_map(30.0, -20.0, 1.2);
  for (int k = 0; k <= 10; ++k) {
    const core::Pose2 displaced(k, k % 2 == 0 ? 0.1 : -0.1, 0.0);
    run.truth.poses.push_back({run.steps[static_cast<std::size_t>(k)].t_ns, core::compose(T_truth_map, displaced)});
  }
  Evaluation evaluation = evaluate(run);
  EXPECT_GT(evaluation.position->error_m.rmse, 10.0);
  EXPECT_NEAR(evaluation.position->rmse_aligned_m, 0.1, 0.01);
  run.truth.frame.is_map = false;
  evaluation = evaluate(run);
  EXPECT_TRUE(evaluation.position->aligned);
  EXPECT_TRUE(evaluation.position->against_poses);
  EXPECT_NEAR(evaluation.position->error_m.rmse, 0.1, 0.01);
  EXPECT_NEAR(evaluation.position->T_truth_map.heading_rad, 1.2, 0.02);
  EXPECT_LT(evaluation.pose->heading_error_rad.rmse, 0.02);
  EXPECT_EQ(evaluation.position->fixes_left_out, 0u);
}

TEST(Evaluation, LeavesNeesOutWhereTheCovarianceIsSingular) {
  runs::Run run = straight_run();
  run.steps[0].pose.covariance.setZero();
  run.truth.poses = {{0, {}}, {run.steps[1].t_ns, core::Pose2(1.0, 0.0, 0.0)}};
  const Evaluation evaluation = evaluate(run);
  EXPECT_EQ(evaluation.pose->nees_count, 1u);
  EXPECT_EQ(evaluation.pose->nees_mean, 0.0);
}

core::PlacedDecision placing(core::PlacedDecision::Verdict verdict) {
  core::PlacedDecision decision;
  decision.verdict = verdict;
  decision.T_map_session = core::Pose2(20.0, -7.0, 0.5);
  return decision;
}

/// The place is found in step 5 on a map that is wrong there by 30 m, as its covariance says; before, the session's own is 0.2 m.
TEST(Evaluation, ComparesWhatWasToldBeforeThePlaceWasFoundWithTheTruthSinceTheBegin) {
  runs::Run run = straight_run();
  const core::Pose2 T_true_map(30.0, 0.0, 0.1);
  run.steps[0].decisions.emplace_back(placing(core::PlacedDecision::Verdict::sought));
  run.steps[5].decisions.emplace_back(placing(core::PlacedDecision::Verdict::accepted));
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    const core::Pose2 known = core::compose(T_true_map, run.steps[k].pose.mean);
    run.truth.poses.push_back({run.steps[k].t_ns, known});
    if (k >= 5) run.steps[k].pose.covariance.diagonal() = Eigen::Vector3d(900.0, 900.0, 0.01);
  }
  run.truth.poses[3].T_world_robot = core::compose(T_true_map, core::Pose2(3.2, 0.3, 0.1));
  const Evaluation evaluation = evaluate(run);
  EXPECT_EQ(evaluation.pose->nees_count, 11u);
  EXPECT_EQ(evaluation.pose->nees_in_own_frame, 5u);
  EXPECT_NEAR(evaluation.pose->errors[1].nees, 0.0, 1e-9);
  EXPECT_NEAR(evaluation.pose->errors[3].nees, 3.0, 1e-9) << "one sigma in each coordinate";
  EXPECT_NEAR(evaluation.pose->errors[10].nees, 2.0, 0.1);
  EXPECT_GT(evaluation.position->errors[1].error_m.norm(), 29.0) << "as the place puts it on the map";
  run.truth.poses.erase(run.truth.poses.begin());
  EXPECT_EQ(evaluate(run).pose->nees_left_out, 4u) << "no truth where it began";
}

/// Carried in step 5 and never found: poses in a frame of their own.
TEST(Evaluation, ComparesAPartThatWasNeverFoundWithTheTruthSinceItBegan) {
  runs::Run run = straight_run();
  core::CarriedDecision carried;
  carried.part = 1;
  run.steps[5].decisions.emplace_back(carried);
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    run.truth.poses.push_back(
        {run.steps[k].t_ns, core::Pose2(static_cast<double>(k) + (k < 5 ? 0.0 : 400.0), 0.0, 0.0)});
  }
  run.truth.poses.push_back({run.steps[4].t_ns + 1, core::Pose2(4.0, 0.0, 0.0)});
  const Evaluation evaluation = evaluate(run);
  EXPECT_LT(evaluation.position->error_m.max, 1e-9);
  EXPECT_LT(evaluation.position->rmse_aligned_m, 1e-9);
  EXPECT_EQ(evaluation.position->fixes_outside, 1u) << "while it was carried";
  EXPECT_EQ(evaluation.pose->nees_in_own_frame, 6u);
  EXPECT_NEAR(evaluation.pose->nees_mean, 0.0, 1e-9);
}

/// The drive was split two scans back: what those scans reported was wrong, and their covariance was in the map frame.
TEST(Evaluation, LeavesNeesOutOfWhatWasMovedAfterwards) {
  runs::Run run = straight_run();
  core::CarriedDecision carried;
  carried.cause = core::CarriedDecision::Cause::by_place;
  carried.part = 1;
  carried.scans = 2;
  run.steps[5].decisions.emplace_back(carried);
  run.steps[5].decisions.emplace_back(placing(core::PlacedDecision::Verdict::accepted));
  for (const core::StepReport& step : run.steps) run.truth.poses.push_back({step.t_ns, step.pose.mean});
  const Evaluation evaluation = evaluate(run);
  EXPECT_EQ(evaluation.pose->nees_count, 9u);
  EXPECT_EQ(evaluation.pose->nees_left_out, 2u);
  EXPECT_EQ(evaluation.position->steps_moved, 2u);
  EXPECT_GT(evaluation.position->moved_m, 1.0);
}

TEST(Evaluation, CountsNisAgainstItsTwoSidedBand) {
  runs::Run run = straight_run();
  const double low = core::chi2_quantile(0.025, 4);
  const double high = core::chi2_quantile(0.975, 4);
  const double nis[] = {low * 0.99, low * 1.01, high * 0.99, high * 1.01};
  for (std::size_t k = 0; k < 4; ++k) {
    run.steps[k].joint_dof = 4;
    run.steps[k].joint_nis = nis[k];
  }
  const Evaluation evaluation = evaluate(run);
  EXPECT_EQ(evaluation.nis.updates, 4u);
  EXPECT_DOUBLE_EQ(evaluation.nis.inside_95, 0.5);
  EXPECT_NEAR(evaluation.nis.mean_per_dof, (low + high) * 2.0 / 16.0, 1e-12);
}

TEST(Evaluation, CountsARevisitOnlyAfterALongAbsence) {
  runs::Run run;
  const auto match_at = [&run](std::int64_t step, double nis) {
    core::StepReport report;
    report.step = step;
    core::AssociationReport match;
    match.outcome = core::Outcome::matched;
    match.landmark = 7;
    match.nis = nis;
    match.dof = 2;
    report.associations = {match};
    run.steps.push_back(report);
  };
  match_at(0, 100.0);    // first sight of all
  match_at(150, 100.0);  // 150 steps later: not yet
  match_at(301, 3.0);    // 151 steps later
  const Evaluation evaluation = evaluate(run);
  EXPECT_EQ(evaluation.revisits.revisits, 1u);
  EXPECT_DOUBLE_EQ(evaluation.revisits.mean_nis_per_dof, 1.5);
}

TEST(Evaluation, OfParticlesHasTheirEffectiveShareAndAncestors) {
  runs::Run run;
  run.steps.resize(4);  // the second was withheld
  run.steps[0].particles = core::CloudReport{100, 50.0, false, -1.0, 100};
  run.steps[2].particles = core::CloudReport{200, 20.0, true, -1.0, 7};
  run.steps[3].particles = core::CloudReport{100, 90.0, true, -1.0, 10};
  const Evaluation evaluation = evaluate(run);
  ASSERT_TRUE(evaluation.particles.has_value());
  EXPECT_EQ(evaluation.particles->scans, 3u);
  EXPECT_DOUBLE_EQ(evaluation.particles->mean_effective_share, 0.5);
  EXPECT_EQ(evaluation.particles->resamplings, 2u);
  EXPECT_DOUBLE_EQ(evaluation.particles->mean_ancestors, 39.0);
  EXPECT_EQ(evaluation.particles->least_ancestors, 7u);
  EXPECT_FALSE(evaluate(runs::Run{}).particles.has_value());
}

TEST(Evaluation, OfARunWithoutStepsOrTruthSaysSo) {
  const Evaluation evaluation = evaluate(runs::Run{});
  EXPECT_FALSE(evaluation.position);
  EXPECT_NE(reports::evaluation_text(evaluation).find("no truth"), std::string::npos);
  EXPECT_TRUE(nlohmann::json::parse(reports::evaluation_json(evaluation))["nis"]["mean_per_dof"].is_null());
  runs::Run empty;
  empty.truth.positions = {{5, {1.0, 2.0}}};
  EXPECT_EQ(evaluate(empty).position->fixes_outside, 1u);
}

TEST(EvaluationText, SaysTheFiguresWithUnits) {
  runs::Run run = straight_run();
  run.truth.poses = {{run.steps[1].t_ns, core::Pose2(1.0, 2.0, 0.0)}};
  const std::string text = reports::evaluation_text(evaluate(run));
  EXPECT_NE(text.find("RMSE 2.000 m"), std::string::npos) << text;
  EXPECT_NE(text.find("NEES"), std::string::npos) << text;
  EXPECT_EQ(text.find("on the given map"), std::string::npos) << text;
}

TEST(EvaluationText, SaysThatTheCovarianceOnAGivenMapLeavesOutItsErrors) {
  runs::Run run = straight_run();
  run.manifest.command = "helixnav replay a.log --localize --map b --out c";
  run.truth.poses = {{run.steps[1].t_ns, core::Pose2(1.0, 2.0, 0.0)}};
  const std::string text = reports::evaluation_text(evaluate(run));
  EXPECT_NE(text.find("NEES"), std::string::npos) << text;
  EXPECT_NE(text.find("on the given map"), std::string::npos) << text;
}

}  // namespace
}  // namespace helixnav::evaluation
