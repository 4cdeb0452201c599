// SPDX-License-Identifier: BSD-3-Clause
// The truth of a run that found its place on the map of an earlier one.
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/decision.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "helixnav/runs/run_recorder.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "run_example.hpp"
#include "temporary_folder.hpp"

namespace helixnav::runs {
namespace {

constexpr core::Nanoseconds second_ns = 1'000'000'000;

/// Along x, sought at the first step and, if it `finds`, found at the third at (10, 0) of the earlier map.
std::vector<core::StepReport> steps_of_session(bool finds) {
  std::vector<core::StepReport> steps(4);
  for (int k = 0; k < 4; ++k) {
    core::StepReport& step = steps[static_cast<std::size_t>(k)];
    step.step = k;
    step.t_ns = k * second_ns;
    step.pose.mean = {1.0 * k, 0.0, 0.0};
  }
  core::PlacedDecision placed;
  placed.verdict = core::PlacedDecision::Verdict::sought;
  steps[0].decisions.emplace_back(placed);
  if (!finds) return steps;
  placed.verdict = core::PlacedDecision::Verdict::accepted;
  placed.T_map_session = {10.0, 0.0, 0.0};
  steps[2].decisions.emplace_back(placed);
  steps[3].pose.mean.x_m += 10.0;
  return steps;
}

/// The session begins at (110, 5) in the room frame in which the truth is given.
core::Recording truth_of_session(const std::optional<core::Pose2>& T_truth_map) {
  core::Recording recording;
  for (int k = 0; k < 4; ++k) recording.true_poses.push_back({k * second_ns, {1.0 * k, 0.0, 0.0}});
  recording.true_landmarks = {{7, {2.0, 1.0}}};
  recording.truth_frame.T_truth_map = core::Pose2(110.0, 5.0, 0.0);
  recording.truth_frame_when_placed = core::TruthFrame{T_truth_map.has_value(), T_truth_map};
  return recording;
}

/// As recorded, and as read back from its folder.
std::pair<runs::Run, runs::Run> run_of(const core::Recording& recording, bool finds) {
  const testing::TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  RunWriter writer(path, example_manifest(), recording);
  RunRecorder recorder(path, example_manifest(), recording);
  for (const core::StepReport& step : steps_of_session(finds)) {
    writer.write(step, 1.0);
    recorder.add(step, 1.0);
  }
  runs::Run made = recorder.finish({});
  writer.finish(made, "", "");
  return {std::move(made), read_run(path)};
}

TEST(TruthFrame, BecomesThatOfTheEarlierMapOnceTheRunIsPlacedOnIt) {
  const auto [made, read] = run_of(truth_of_session(core::Pose2(100.0, 5.0, 0.0)), true);
  for (const runs::Run* run : {&made, &read}) {
    ASSERT_TRUE(run->truth.frame.is_map);
    EXPECT_EQ(run->truth.frame.T_truth_map->x_m, 100.0) << "for who goes on in this run";
    EXPECT_NEAR(run->truth.poses[3].T_world_robot.x_m, 13.0, 1e-12);
    EXPECT_NEAR(run->truth.landmarks[0].point_m.x(), 12.0, 1e-12);
    EXPECT_NEAR(run->steps[3].pose.mean.x_m, 13.0, 1e-12);
  }
}

TEST(TruthFrame, StaysThatOfTheSessionWhereThePlaceIsNotFound) {
  const auto [made, read] = run_of(truth_of_session(core::Pose2(100.0, 5.0, 0.0)), false);
  for (const runs::Run* run : {&made, &read}) {
    ASSERT_TRUE(run->truth.frame.is_map);
    EXPECT_EQ(run->truth.frame.T_truth_map->x_m, 110.0);
    EXPECT_NEAR(run->truth.poses[3].T_world_robot.x_m, 3.0, 1e-12);
  }
}

TEST(TruthFrame, IsOneOfItsOwnWhereNobodyKnowsWhereTheEarlierMapLiesInIt) {
  core::Recording of_earlier_version = truth_of_session(std::nullopt);
  of_earlier_version.truth_frame = {};
  of_earlier_version.truth_frame_when_placed.reset();
  for (const core::Recording& recording : {truth_of_session(std::nullopt), of_earlier_version}) {
    const auto [made, read] = run_of(recording, true);
    EXPECT_FALSE(made.truth.frame.is_map);
    EXPECT_FALSE(read.truth.frame.is_map);
    EXPECT_FALSE(read.truth.frame.T_truth_map);
  }
}

/// A drive and its truth; the vehicle is carried before step 2 and from then on does not know its place.
std::pair<runs::Run, runs::Run> run_of_carried(core::Nanoseconds truth_late_ns, std::string& frames) {
  core::Recording recording;
  for (int k = 0; k < 4; ++k) {
    const core::Pose2 first(1.0 * k, 0.0, 0.0), second(50.0, 1.0 * k - 2.0, 0.5 * core::pi);
    recording.true_poses.push_back({k * second_ns + (k > 1 ? truth_late_ns : 0), k < 2 ? first : second});
  }
  recording.truth_frame.T_truth_map = core::Pose2(110.0, 5.0, 0.0);
  const testing::TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  RunWriter writer(path, example_manifest(), recording);
  RunRecorder recorder(path, example_manifest(), recording);
  for (int k = 0; k < 4; ++k) {
    core::StepReport step;
    step.step = k;
    step.t_ns = k * second_ns;
    step.pose.mean = {k < 2 ? 1.0 * k : 1.0 * k - 2.0, 0.0, 0.0};
    core::CarriedDecision carried;
    carried.part = 1;
    if (k == 2) step.decisions.emplace_back(carried);
    writer.write(step, 1.0);
    recorder.add(step, 1.0);
  }
  runs::Run made = recorder.finish({});
  writer.finish(made, "", "");
  frames = files::read_whole_file(path + "/truth_frame.csv");
  return {std::move(made), read_run(path)};
}

TEST(TruthFrame, OfAMapOfAPartThatWasNotFoundIsThatPartsOwn) {
  std::string frames;
  const auto [made, read] = run_of_carried(0, frames);
  for (const runs::Run* run : {&made, &read}) {
    const std::optional<core::Pose2> T_truth_map = T_truth_of_map(*run);
    ASSERT_TRUE(T_truth_map);
    EXPECT_NEAR(T_truth_map->x_m, 160.0, 1e-12);
    EXPECT_NEAR(T_truth_map->y_m, 5.0, 1e-12);
    EXPECT_NEAR(T_truth_map->heading_rad, 0.5 * core::pi, 1e-12);
    EXPECT_EQ(run->truth.frame.T_truth_map->x_m, 110.0) << "of the truth of the drive";
  }
  EXPECT_NE(frames.find("\nend,1,160,5,"), std::string::npos) << frames;
}

TEST(TruthFrame, OfAMapOfAPartWithoutATruePoseAtItsBeginIsNotKnown) {
  std::string frames;
  const auto [made, read] = run_of_carried(second_ns, frames);
  EXPECT_FALSE(T_truth_of_map(made));
  EXPECT_FALSE(T_truth_of_map(read));
  EXPECT_NE(frames.find("\nend,0,0,0,0"), std::string::npos) << frames;
}

}  // namespace
}  // namespace helixnav::runs
