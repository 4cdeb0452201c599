// SPDX-License-Identifier: BSD-3-Clause
#include "settled_drive.hpp"

#include <set>
#include <vector>

#include "common/chosen_navigator.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/event_loop.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "smooth/smoothing_run.hpp"

namespace helixnav::apps {
namespace {

core::Recording without_fixes(const core::Recording& recording) {
  core::Recording rest;
  rest.start = recording.start;
  rest.name = recording.name;
  for (const core::Event& event : recording.events) {
    if (!std::holds_alternative<core::AbsoluteFix>(event)) rest.events.push_back(event);
  }
  return rest;
}

/// Of landmarks that lasted; clutter and what was seen once say nothing.
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

}  // namespace

SettledDrive settle(const core::Recording& recording, const supervisor::NavigatorOptions& options,
                    bool known_association) {
  ChosenNavigator navigator(recording, options, known_association);
  core::EventLoop loop(recording.events, navigator);
  std::vector<core::StepReport> steps;
  SettledDrive drive;
  double nis = 0.0;
  int rows = 0;
  while (std::optional<core::StepReport> step = loop.next()) {
    nis += step->joint_nis;
    rows += step->joint_dof;
    for (const core::Decision& decision : step->decisions) {
      drive.closings += core::is_closure(decision) && core::row_of(decision).verdict == std::string("accepted") ? 1 : 0;
    }
    drive.observations += step->associations.size();
    steps.push_back(std::move(*step));
  }
  const std::vector<core::MapLandmark> map = navigator.map();
  const core::Recording driven = without_fixes(recording);
  SmoothingTask task = task_from_recording(driven, ids_of_mature(steps, driven, map));
  if (task.problem.graph.landmark_edges.empty()) {
    throw core::InputError(recording.name +
                           ": the run maps no landmark, so that nothing can be calibrated; 'helixnav check' "
                           "shows what was understood");
  }
  std::vector<core::Pose2> poses;
  for (const core::StepReport& step : steps) poses.push_back(step.pose.mean);
  start_from_run(recording.name, steps, poses, map, task);
  smoothing::Options solver;
  solver.first_damping = 1e-8;
  smoothing::optimize(task.problem, solver);
  drive.used = task.problem.graph.landmark_edges.size();
  drive.nis_per_dof = rows > 0 ? nis / rows : 0.0;
  drive.problem = std::move(task.problem);
  return drive;
}

}  // namespace helixnav::apps
