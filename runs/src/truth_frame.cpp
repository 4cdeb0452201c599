// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>
#include <variant>

#include "helixnav/runs/run.hpp"

namespace helixnav::runs {
namespace {

bool are_equal(const core::Pose2& a, const core::Pose2& b) { return a.vector() == b.vector(); }

}  // namespace

bool began_off_earlier_map(const Run& run) {
  if (run.steps.empty()) return false;
  const auto& decisions = run.steps.front().decisions;
  return std::any_of(decisions.begin(), decisions.end(), [](const core::Decision& decision) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    return placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::sought;
  });
}

/// Part 0 is the earlier map of a session that began elsewhere.
bool is_on_earlier_map(const Run& run) {
  const auto places = [](const core::Decision& decision) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    return placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted && placed->part == 0;
  };
  return std::any_of(run.steps.begin(), run.steps.end(), [&](const core::StepReport& step) {
    return std::any_of(step.decisions.begin(), step.decisions.end(), places);
  });
}

void move_truth(const std::optional<core::Pose2>& T_truth_map, core::TruthFrame& frame,
                std::vector<core::TruePose>& poses, std::vector<core::TrueLandmark>& landmarks) {
  const std::optional<core::Pose2> T_truth_before = frame.T_truth_map;
  frame.is_map = T_truth_map && T_truth_before;
  frame.T_truth_map = frame.is_map ? T_truth_map : std::nullopt;
  if (!frame.is_map || are_equal(*T_truth_map, *T_truth_before)) return;
  const core::Pose2 T_map_before = core::between(*T_truth_map, *T_truth_before);
  for (core::TruePose& pose : poses) pose.T_world_robot = core::compose(T_map_before, pose.T_world_robot);
  for (core::TrueLandmark& landmark : landmarks) landmark.point_m = core::transform(T_map_before, landmark.point_m);
}

void bring_truth_into_map(Run& run) {
  RunTruth& truth = run.truth;
  const std::optional<core::TruthFrame> placed = std::exchange(truth.frame_when_placed, std::nullopt);
  if (truth.poses.empty() || !is_on_earlier_map(run)) return;
  if (!placed && !began_off_earlier_map(run)) return;  // a folder of an earlier version
  std::vector<core::TrueLandmark> none;                // beside positions, landmarks are in the frame of these
  move_truth(placed ? placed->T_truth_map : std::nullopt, truth.frame, truth.poses,
             truth.positions.empty() ? truth.landmarks : none);
}

}  // namespace helixnav::runs
