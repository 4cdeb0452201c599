// SPDX-License-Identifier: BSD-3-Clause
#include "settled_drive.hpp"

#include <algorithm>
#include <set>
#include <variant>
#include <vector>

#include "common/chosen_navigator.hpp"
#include "common/progress_bar.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/event_loop.hpp"
#include "keep_scans.hpp"
#include "slipped_scans.hpp"
#include "smooth/smoothing_run.hpp"
#include "stop_if_interrupted.hpp"
#include "without_fixes.hpp"

namespace helixnav::apps {
namespace {

/// Of landmarks that lasted; clutter and landmarks seen only once carry no information.
Ids ids_of_mature(const std::vector<core::StepReport>& steps, const core::Recording& recording,
                  const std::vector<core::MapLandmark>& map) {
  std::set<std::int64_t> mature;
  for (const core::MapLandmark& landmark : map) {
    if (landmark.state == core::LandmarkState::mature) mature.insert(landmark.id);
  }
  Ids ids = ids_of_run(steps, recording);
  for (auto& of_scan : ids) {
    for (std::int64_t& id : of_scan) id = mature.count(id) > 0 ? id : core::no_label;
  }
  return ids;
}

double nis_per_dof(const std::vector<core::StepReport>& steps, double from_share) {
  double nis = 0.0;
  int rows = 0;
  for (auto k = static_cast<std::size_t>(from_share * static_cast<double>(steps.size())); k < steps.size(); ++k) {
    nis += steps[k].joint_nis;
    rows += steps[k].joint_dof;
  }
  return rows > 0 ? nis / rows : 0.0;
}

}  // namespace

SettledDrive drive_through(const core::Recording& recording, const supervisor::NavigatorOptions& options,
                           bool known_association) {
  ChosenNavigator navigator(recording, options, known_association);
  core::EventLoop loop(recording.events, navigator);
  std::vector<core::StepReport> steps;
  SettledDrive drive;
  ProgressBar progress("navigating", scans_of(recording), false);
  while (std::optional<core::StepReport> step = loop.next()) {
    stop_if_interrupted();
    progress.advance_to(steps.size());
    for (const core::Decision& decision : step->decisions) {
      drive.closings += core::is_closure(decision) && core::row_of(decision).verdict == std::string("accepted") ? 1 : 0;
    }
    drive.observations += step->associations.size();
    steps.push_back(std::move(*step));
  }
  const std::vector<core::MapLandmark> map = navigator.map();
  core::Recording driven = without_fixes(recording);
  drive.slipped = slipped_scans(steps);
  loosen_odometry(drive.slipped, driven);
  drive.ids = ids_of_mature(steps, driven, map);
  SmoothingTask task = task_from_recording(driven, drive.ids);
  if (task.problem.graph.landmark_edges.empty()) {
    throw core::InputError(recording.name +
                           ": the run maps no landmark, so that nothing can be calibrated; 'helixnav check' "
                           "shows what was understood");
  }
  std::vector<core::Pose2> poses;
  for (const core::StepReport& step : steps) poses.push_back(step.pose.mean);
  start_from_run(recording.name, steps, poses, map, task);
  drive.used = task.problem.graph.landmark_edges.size();
  drive.nis_per_dof = nis_per_dof(steps, 0.0);
  drive.nis_per_dof_held_out = nis_per_dof(steps, 1.0 - 1.0 / parts_held_out);
  drive.task = std::move(task);
  return drive;
}

}  // namespace helixnav::apps
