// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bring_into_map.hpp"
#include "helixnav/core/interpolate.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::runs {
namespace {

bool are_equal(const core::Pose2& a, const core::Pose2& b) { return a.vector() == b.vector(); }

/// The estimate at a true pose within the first scan of a part, as near its start as the truth allows.
std::optional<core::Pose2> pose_since(const std::vector<core::StepReport>& steps, std::size_t begin,
                                      core::Nanoseconds t_ns) {
  const core::StepReport& first = steps[begin];
  if (t_ns == first.t_ns) return first.pose.mean;
  if (begin + 1 == steps.size() || t_ns >= steps[begin + 1].t_ns) return std::nullopt;
  const core::StepReport& next = steps[begin + 1];
  const double fraction = static_cast<double>(t_ns - first.t_ns) / static_cast<double>(next.t_ns - first.t_ns);
  return core::interpolate(first.pose.mean, next.pose.mean, fraction);
}

/// Pose of a part in the frame of the true poses, from where the vehicle was when it started.
std::optional<core::Pose2> T_poses_part(const Run& run, std::size_t begin) {
  const std::vector<core::TruePose>& poses = run.truth.poses;
  const auto known = std::lower_bound(poses.begin(), poses.end(), run.steps[begin].t_ns,
                                      [](const core::TruePose& pose, core::Nanoseconds t) { return pose.t_ns < t; });
  if (known == poses.end()) return std::nullopt;
  const std::optional<core::Pose2> T_part_robot = pose_since(run.steps, begin, known->t_ns);
  if (!T_part_robot) return std::nullopt;
  return core::compose(known->T_world_robot, core::inverse(*T_part_robot));
}

/// The run made no map: its map.csv is the one it was given.
bool keeps_given_map(const Run& run) { return run.manifest.command.find(" --localize") != std::string::npos; }

}  // namespace

bool began_off_earlier_map(const Run& run) {
  if (run.steps.empty()) return false;
  const auto& decisions = run.steps.front().decisions;
  return std::any_of(decisions.begin(), decisions.end(), [](const core::Decision& decision) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    return placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::sought;
  });
}

/// Part 0 is the earlier map of a session that started elsewhere.
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

std::optional<std::size_t> begin_of_last_part(const Run& run) {
  const std::vector<FrameOfStep> frames = frames_of(run);
  if (frames.empty() || keeps_given_map(run)) return std::nullopt;
  const int of_truth = began_off_earlier_map(run) && !is_on_earlier_map(run) ? 1 : 0;
  const int last = frames.back().part;
  if (last == of_truth) return std::nullopt;
  const auto begin = std::find_if(frames.begin(), frames.end(), [last](const FrameOfStep& frame) {
    return frame.part == last && frame.reported_part == last;
  });
  return static_cast<std::size_t>(begin - frames.begin());
}

std::optional<core::Pose2> T_truth_of_map(const Run& run) {
  const std::optional<core::Pose2>& T_truth_poses = run.truth.frame.T_truth_map;
  if (keeps_given_map(run) && began_off_earlier_map(run) && !is_on_earlier_map(run)) return std::nullopt;
  const std::optional<std::size_t> begin = begin_of_last_part(run);
  if (!begin || !T_truth_poses) return T_truth_poses;
  const std::optional<core::Pose2> T_poses_map = T_poses_part(run, *begin);
  if (!T_poses_map) return std::nullopt;
  return core::compose(*T_truth_poses, *T_poses_map);
}

}  // namespace helixnav::runs
