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
