// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "helixnav/core/decision_row.hpp"
#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "run_example.hpp"
#include "temporary_folder.hpp"

namespace helixnav::runs {
namespace {

Run along_x(int steps) {
  Run run;
  for (int k = 0; k < steps; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.step = k;
    step.t_ns = k * 1'000'000'000LL;
    step.pose.mean = {1.0 * k, 0.0, 0.0};
  }
  return run;
}

TEST(FinalPath, TakesThePosesSolvedAndTheMotionWhereThereIsNone) {
  runs::Run run = along_x(5);
  // Turned to the left; nothing is known about step 1, nor about anything after 3.
  correct_path(run, {{0, {0.0, 0.0, 1.5}}, {2'000'000'000, {0.0, 2.0, 1.5}}, {3'000'000'000, {0.0, 3.0, 1.5}}});
  ASSERT_EQ(run.final_path.size(), 5u);
  EXPECT_NEAR(run.final_path[1].x_m, std::cos(1.5), 1e-12);
  EXPECT_NEAR(run.final_path[1].y_m, std::sin(1.5), 1e-12);
  EXPECT_EQ(run.final_path[3].y_m, 3.0);
  EXPECT_EQ(run.final_path[4].x_m, 4.0) << "as estimated since";
}

TEST(FinalPath, IsEmptyWhereNothingWasSolved) {
  runs::Run run = along_x(5);
  correct_path(run, {});
  EXPECT_TRUE(run.final_path.empty());
}

core::PlacedDecision placed_at(const core::Pose2& T_map_session) {
  core::PlacedDecision placed;
  placed.verdict = core::PlacedDecision::Verdict::accepted;
  placed.T_map_session = T_map_session;
  return placed;
}

/// A part that was driven again, because its first place was wrong, is solved in the frame with which it began. Its path came out as
/// far off as that frame is from the map.
TEST(FinalPath, OfAPartThatWasPlacedAgainIsInTheFrameOfTheMap) {
  runs::Run run = along_x(6);
  core::PlacedDecision sought;
  sought.verdict = core::PlacedDecision::Verdict::sought;
  run.steps[0].decisions.emplace_back(sought);
  run.steps[2].decisions.emplace_back(placed_at({10.0, 0.0, 1.0}));
  core::CarriedDecision again;
  again.cause = core::CarriedDecision::Cause::wrong_place;
  again.part = 2;
  again.scans = 4;
  const core::Pose2 T_map_session(20.0, 5.0, 0.5);
  run.steps[4].decisions.emplace_back(again);
  run.steps[4].decisions.emplace_back(placed_at(core::compose(T_map_session, core::inverse({10.0, 0.0, 1.0}))));
  std::vector<core::StampedPose> solved;
  for (int k = 0; k < 5; ++k) solved.push_back({k * 1'000'000'000LL, {1.0 * k, 0.0, 0.0}});
  correct_path(run, solved);
  ASSERT_EQ(run.final_path.size(), 6u);
  for (std::size_t k = 0; k < 5; ++k) {
    const core::Pose2 expected = core::compose(T_map_session, solved[k].T_world_robot);
    EXPECT_LT((run.final_path[k].position_m() - expected.position_m()).norm(), 1e-9) << k;
  }
}

TEST(FinalPath, OfAClosingIsWrittenReadAndJudged) {
  const testing::TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  core::Recording recording;
  for (int k = 0; k < 5; ++k) recording.true_poses.push_back({k * 1'000'000'000LL, {1.0 * k, 0.25, 0.0}});
  RunWriter writer(path, example_manifest(), recording);
  RunRecorder recorder(path, example_manifest(), recording);
  for (core::StepReport step : along_x(5).steps) {
    if (step.step == 4) {
      for (const core::TruePose& pose : recording.true_poses) step.solved.push_back({pose.t_ns, pose.T_world_robot});
    }
    writer.write(step, 1.0);
    recorder.add(step, 1.0);
  }
  const runs::Run made = recorder.finish({});
  writer.finish(made, "", "");
  const runs::Run read = read_run(path);
  ASSERT_EQ(read.final_path.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(read.final_path[k].vector(), made.final_path[k].vector());
  const evaluation::Evaluation evaluation = evaluation::evaluate(read);
  EXPECT_NEAR(evaluation.position->error_m.rmse, 0.25, 1e-12);
  EXPECT_NEAR(evaluation.final_position->error_m.rmse, 0.0, 1e-12);
}

}  // namespace
}  // namespace helixnav::runs
