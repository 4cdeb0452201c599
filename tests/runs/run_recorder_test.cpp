// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/run_recorder.hpp"
#include "helixnav/core/decision_row.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "run_example.hpp"
#include "temporary_folder.hpp"

namespace helixnav::runs {
namespace {

using helixnav::testing::TemporaryFolder;

void expect_equal(const core::AssociationReport& a, const core::AssociationReport& b) {
  EXPECT_EQ(a.observation, b.observation);
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.landmark, b.landmark);
  EXPECT_EQ(a.nis, b.nis);
  EXPECT_EQ(a.dof, b.dof);
  EXPECT_EQ(a.margin_nats, b.margin_nats);
}

/// Bit for bit: judging at the end of a run and judging later from its folder must not differ.
void expect_equal(const core::StepReport& a, const core::StepReport& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.t_ns, b.t_ns);
  EXPECT_EQ(a.mode, b.mode);
  EXPECT_EQ(a.pose.mean.vector(), b.pose.mean.vector());
  EXPECT_EQ(a.pose.covariance, b.pose.covariance);
  EXPECT_EQ(a.joint_nis, b.joint_nis);
  EXPECT_EQ(a.joint_dof, b.joint_dof);
  EXPECT_EQ(a.active_landmarks, b.active_landmarks);
  EXPECT_EQ(a.mapped_landmarks, b.mapped_landmarks);
  EXPECT_EQ(a.switched_region, b.switched_region);
  ASSERT_EQ(a.associations.size(), b.associations.size());
  for (std::size_t i = 0; i < a.associations.size(); ++i) expect_equal(a.associations[i], b.associations[i]);
  ASSERT_EQ(a.decisions.size(), b.decisions.size());
  for (std::size_t i = 0; i < a.decisions.size(); ++i) {
    EXPECT_EQ(core::row_of(a.decisions[i]).kind, core::row_of(b.decisions[i]).kind);
    EXPECT_EQ(core::row_of(a.decisions[i]).numbers, core::row_of(b.decisions[i]).numbers);
  }
  ASSERT_EQ(a.merged.size(), b.merged.size());
  for (std::size_t i = 0; i < a.merged.size(); ++i) EXPECT_EQ(a.merged[i].removed, b.merged[i].removed);
  ASSERT_EQ(a.cloud.size(), b.cloud.size());
  for (std::size_t i = 0; i < a.cloud.size(); ++i) EXPECT_EQ(a.cloud[i].vector(), b.cloud[i].vector());
  EXPECT_TRUE(a.revised.empty() && b.revised.empty());
  EXPECT_TRUE(a.drawn.empty() && b.drawn.empty());
}

/// Steps with arbitrary headings and covariances symmetric only up to rounding, some of which revise earlier ones.
core::StepReport awkward_step(std::int64_t k) {
  core::RandomStream random(static_cast<std::uint64_t>(k), "awkward");
  core::StepReport step = example_step(k);
  step.pose.mean = core::Pose2(random.uniform(-1e3, 1e3), random.uniform(), random.uniform(-core::pi, core::pi));
  for (int i = 0; i < 9; ++i) step.pose.covariance(i) += 1e-12 * random.uniform();
  if (k % 7 == 6) {
    core::AssociationReport changed = step.associations.empty() ? core::AssociationReport{} : step.associations[0];
    changed.landmark = 77;
    step.revised = {{k - 2, {changed, {99, core::Outcome::augmented, 5, 1.0 / 3.0, 2, 0.0}}}, {k + 5, {changed}}};
  }
  return step;
}

core::Recording awkward_recording(std::int64_t steps) {
  core::Recording recording = example_recording(steps);
  recording.labels.resize(static_cast<std::size_t>(steps) + 3);  // of scans that saw nothing
  recording.antenna_robot_m = {3.0, 0.5};                        // without any fix
  return recording;
}

TEST(RunRecorder, MakesTheRunThatIsReadFromTheFolder) {
  constexpr std::int64_t steps = 300;
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  RunWriter writer(path, example_manifest(), awkward_recording(steps));
  RunRecorder recorder(path, example_manifest(), awkward_recording(steps));
  for (std::int64_t k = 0; k < steps; ++k) {
    writer.write(awkward_step(k), 1.0 / 3.0);
    recorder.add(awkward_step(k), 1.0 / 3.0);
  }
  std::vector<core::MapLandmark> map = example_map();
  map[0].point.covariance_m2(1, 0) = 1e-9;
  const runs::Run made = recorder.finish(map);
  writer.finish(made, "", "");
  const runs::Run read = read_run(path);
  EXPECT_EQ(made.path, read.path);
  EXPECT_EQ(made.finished, read.finished);
  EXPECT_EQ(manifest_json(made.manifest), manifest_json(read.manifest));
  EXPECT_EQ(made.microseconds, read.microseconds);
  ASSERT_EQ(made.steps.size(), read.steps.size());
  for (std::size_t k = 0; k < made.steps.size(); ++k) expect_equal(made.steps[k], read.steps[k]);
  ASSERT_EQ(made.map.size(), read.map.size());
  for (std::size_t i = 0; i < made.map.size(); ++i) {
    EXPECT_EQ(made.map[i].point.mean_m, read.map[i].point.mean_m);
    EXPECT_EQ(made.map[i].point.covariance_m2, read.map[i].point.covariance_m2);
    EXPECT_EQ(made.map[i].state, read.map[i].state);
  }
  EXPECT_EQ(made.truth.labels, read.truth.labels);
  EXPECT_EQ(made.truth.antenna_robot_m, read.truth.antenna_robot_m);
  ASSERT_EQ(made.truth.poses.size(), read.truth.poses.size());
  for (std::size_t i = 0; i < made.truth.poses.size(); ++i) {
    EXPECT_EQ(made.truth.poses[i].T_world_robot.vector(), read.truth.poses[i].T_world_robot.vector());
  }
}

}  // namespace
}  // namespace helixnav::runs
