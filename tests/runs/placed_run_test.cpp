// SPDX-License-Identifier: BSD-3-Clause
// A session that found its place on an earlier map is a run in one frame, in memory and in its folder.
#include <gtest/gtest.h>

#include <filesystem>

#include "helixnav/runs/joint_map_file.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "helixnav/runs/run_recorder.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "temporary_folder.hpp"

namespace helixnav::runs {
namespace {

const core::Pose2 T_map_session(10.0, -5.0, 1.0);

core::StepReport step_at(int k, bool in_map) {
  core::StepReport step;
  step.step = k;
  step.t_ns = 1000000000LL * k;
  const core::Pose2 own(0.5 * k, 0.1 * k, 0.02 * k);
  step.pose.mean = in_map ? core::compose(T_map_session, own) : own;
  step.pose.covariance = Eigen::Vector3d(1.0, 4.0, 0.01).asDiagonal();
  return step;
}

core::PlacedDecision placed(core::PlacedDecision::Verdict verdict) {
  core::PlacedDecision decision;
  decision.verdict = verdict;
  decision.T_map_session = T_map_session;
  return decision;
}

/// Six steps, placed in the fourth; `from_the_begin`: not because the place had been known and was lost.
runs::Run write_run(const std::string& folder, bool from_the_begin) {
  RunWriter writer(folder, {}, {});
  RunRecorder recorder(folder, {}, {});
  for (int k = 0; k < 6; ++k) {
    core::StepReport step = step_at(k, k >= 3);
    if (k == 0 && from_the_begin) step.decisions.emplace_back(placed(core::PlacedDecision::Verdict::sought));
    if (k == 3) step.decisions.emplace_back(placed(core::PlacedDecision::Verdict::accepted));
    writer.write(step, 0.0);
    recorder.add(step, 0.0);
  }
  runs::Run run = recorder.finish({});
  run.joint_map.emplace();
  run.joint_map->joint.covariance = Eigen::MatrixXd::Identity(3, 3);
  writer.finish(run, "page", "{}");
  return run;
}

TEST(PlacedRun, HasOneFrameInMemoryAndInItsFolder) {
  const testing::TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  const runs::Run run = write_run(path, true);
  const runs::Run read = read_run(path);
  ASSERT_EQ(read.steps.size(), 6u);
  for (int k = 0; k < 6; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const core::Pose2 expected = step_at(k, true).pose.mean;
    EXPECT_LT((run.steps[i].pose.mean.vector() - expected.vector()).norm(), 1e-12);
    EXPECT_LT((read.steps[i].pose.mean.vector() - run.steps[i].pose.mean.vector()).norm(), 1e-12);
    EXPECT_LT((read.steps[i].pose.covariance - run.steps[i].pose.covariance).norm(), 1e-12);
  }
  EXPECT_NE(run.steps[0].pose.covariance(0, 1), 0.0) << "turned with the frame";
  EXPECT_EQ(run.steps[3].pose.covariance(0, 1), 0.0);
  EXPECT_TRUE(std::filesystem::exists(path + "/trajectory_final.tum"));
  EXPECT_TRUE(read_joint_map(path + "/map.bin").joint.ids.empty());
}

/// Carried before step 2 and before step 4; the third part finds the second in step 6, and both the first in step 8.
TEST(PlacedRun, OfSeveralPartsHasOneFrameOnceTheyAreFound) {
  const core::Pose2 T_second_third(3.0, 1.0, -0.5);
  const core::Pose2 T_first_second(10.0, -5.0, 1.0);
  const auto truth = [](int k) { return core::Pose2(0.5 * k, 0.1 * k, 0.02 * k); };
  RunRecorder recorder("run", {}, {});
  for (int k = 0; k < 10; ++k) {
    core::StepReport step = step_at(k, false);
    const core::Pose2 T_first_now = k < 2 || k >= 8 ? core::Pose2() : T_first_second;
    step.pose.mean = core::compose(core::inverse(T_first_now), truth(k));
    if (k == 4 || k == 5) step.pose.mean = core::compose(core::inverse(T_second_third), step.pose.mean);
    if (k == 2 || k == 4) {
      core::CarriedDecision carried;
      carried.part = k / 2;
      step.decisions.emplace_back(carried);
    }
    if (k == 6 || k == 8) {
      core::PlacedDecision found = placed(core::PlacedDecision::Verdict::accepted);
      found.part = k == 6 ? 1 : 0;
      found.T_map_session = k == 6 ? T_second_third : T_first_second;
      step.decisions.emplace_back(found);
    }
    if (k == 1) step.solved = {{0, {0.0, 0.0, 0.3}}, {step.t_ns, {0.5, 0.25, 0.3}}};
    recorder.add(step, 0.0);
  }
  const runs::Run run = recorder.finish({});
  for (int k = 0; k < 10; ++k) {
    const auto i = static_cast<std::size_t>(k);
    EXPECT_LT((run.steps[i].pose.mean.vector() - truth(k).vector()).norm(), 1e-12) << k;
    if (k >= 2) {
      EXPECT_LT((run.final_path[i].vector() - truth(k).vector()).norm(), 1e-12) << k;
    }
  }
  EXPECT_NEAR(run.final_path[1].y_m, 0.25, 1e-12) << "what was solved of the first part";
}

/// Discovered two scans later, when the place was found immediately.
TEST(PlacedRun, APartMayHaveBegunBeforeAnybodyKnew) {
  const auto truth = [](int k) { return core::Pose2(0.5 * k, 0.1 * k, 0.02 * k); };
  RunRecorder recorder("run", {}, {});
  for (int k = 0; k < 8; ++k) {
    core::StepReport step = step_at(k, false);
    const bool is_elsewhere = k == 3 || k == 4;
    step.pose.mean = is_elsewhere ? core::compose(core::inverse(T_map_session), truth(k)) : truth(k);
    if (k == 5) {
      core::CarriedDecision carried;
      carried.cause = core::CarriedDecision::Cause::by_place;
      carried.part = 1;
      carried.scans = 2;
      step.decisions.emplace_back(carried);
      step.decisions.emplace_back(placed(core::PlacedDecision::Verdict::accepted));
    }
    recorder.add(step, 0.0);
  }
  const runs::Run run = recorder.finish({});
  for (int k = 0; k < 8; ++k) {
    const auto i = static_cast<std::size_t>(k);
    EXPECT_LT((run.steps[i].pose.mean.vector() - truth(k).vector()).norm(), 1e-12) << k;
  }
}

/// In one scan the session's own drive is solved, and then the place of the session is found.
TEST(PlacedRun, OfTheScanThatFoundThePlaceTheSolvedPoseIsMovedToo) {
  RunRecorder recorder("run", {}, {});
  for (int k = 0; k < 6; ++k) {
    core::StepReport step = step_at(k, k >= 3);
    if (k == 0) step.decisions.emplace_back(placed(core::PlacedDecision::Verdict::sought));
    if (k == 3) {
      for (int i = 0; i <= k; ++i) step.solved.push_back({1000000000LL * i, step_at(i, false).pose.mean});
      step.decisions.emplace_back(placed(core::PlacedDecision::Verdict::accepted));
    }
    recorder.add(step, 0.0);
  }
  const runs::Run run = recorder.finish({});
  for (int k = 0; k < 6; ++k) {
    const core::Pose2 expected = step_at(k, true).pose.mean;
    EXPECT_LT((run.final_path[static_cast<std::size_t>(k)].vector() - expected.vector()).norm(), 1e-12) << k;
  }
}

TEST(PlacedRun, WhatWasKnownBeforeItWasLostStaysWhereItIs) {
  const testing::TemporaryFolder folder;
  const runs::Run run = write_run((folder.path() / "run").string(), false);
  EXPECT_EQ(run.steps[1].pose.mean.x_m, 0.5);
}

}  // namespace
}  // namespace helixnav::runs
