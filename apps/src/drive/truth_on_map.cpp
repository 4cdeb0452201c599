// SPDX-License-Identifier: BSD-3-Clause
#include "truth_on_map.hpp"

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "helixnav/runs/run.hpp"
#include "helixnav/runs/run_folder.hpp"

namespace helixnav::apps {
namespace {

void move_to(const std::optional<core::Pose2>& T_truth_map, core::Recording& recording) {
  std::vector<core::TrueLandmark> none;  // beside positions, landmarks are in the frame of these
  runs::move_truth(T_truth_map, recording.truth_frame, recording.true_poses,
                   recording.true_positions.empty() ? recording.true_landmarks : none);
}

/// A session that looks for its place calls its own start the origin.
void seek(const std::optional<core::Pose2>& T_truth_map, core::Recording& recording) {
  std::optional<core::Pose2>& T_truth_start = recording.truth_frame.T_truth_map;
  if (T_truth_start) move_to(core::compose(*T_truth_start, recording.start.mean), recording);
  recording.truth_frame_when_placed = core::TruthFrame{T_truth_map.has_value(), T_truth_map};
}

}  // namespace

void put_truth_on_map(Drive& job) {
  if (job.recording.true_poses.empty()) return;
  if (job.earlier) {
    const bool is_sought = job.earlier->start.kind == SessionStart::Kind::unknown;
    is_sought ? seek(job.earlier->T_truth_map, job.recording) : move_to(job.earlier->T_truth_map, job.recording);
  } else if (job.given_map) {
    const GivenMap& map = *job.given_map;
    if (map.start && map.start->kind == SessionStart::Kind::unknown) return seek(map.T_truth_map, job.recording);
    // Without a pose it begins as in the log, which is then all that is known of its place on the map.
    const bool both_known = map.T_truth_map && job.recording.truth_frame.T_truth_map;
    if (map.start || both_known) move_to(map.T_truth_map, job.recording);
  }
}

void put_truth_behind(const std::string& folder, std::size_t driven, core::Recording& recording) {
  if (recording.true_poses.empty()) return;
  std::optional<core::Pose2> T_truth_map;
  if (std::filesystem::exists(std::filesystem::path(folder) / "manifest.json"))
    T_truth_map = runs::read_run(folder).truth.frame.T_truth_map;
  if (driven > 0 && !T_truth_map) return;  // it is the log of that drive, and begins where that began
  move_to(T_truth_map, recording);
}

}  // namespace helixnav::apps
