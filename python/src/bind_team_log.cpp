// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bind.hpp"
#include "common/input_files.hpp"
#include "configuration.hpp"
#include "gil.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"
#include "helixnav/logs/mrclam.hpp"
#include "helixnav/sim/team_world.hpp"
#include "map.hpp"
#include "signals.hpp"
#include "team/team_folder.hpp"
#include "team_log.hpp"

namespace helixnav::python {
namespace {

namespace fs = std::filesystem;

TeamLog read_team_log(const fs::path& path, const std::vector<int>& robots, const py::dict& options) {
  const Configuration configuration = configuration_of(options);
  for (const std::string& key : configuration.keys) {
    if (key.rfind("mrclam.", 0) != 0) throw core::InputError(key + ": is not for several robots; mrclam.… are");
  }
  const WithoutGil released;
  return {logs::read_mrclam(path, robots, configuration.settings.logs.mrclam), {path.string()}, 0};
}

TeamLog simulate_team(int robots, std::uint64_t seed) {
  sim::TeamWorldOptions world;
  world.robots = robots;
  world.see_each_other = true;
  return {sim::simulate_team(world, seed), {}, seed};
}

void write_run(const TeamLog& log, const std::string& out, bool overwrite, const TeamRun& run) {
  runs::RunManifest manifest;
  manifest.version = core::version();
  manifest.commit = core::commit();
  manifest.command = "python: helixnav.replay_team";
  manifest.seed = log.seed;
  for (const std::string& file : log.files) {
    const std::vector<runs::InputFile> inputs = apps::input_files(file);
    manifest.inputs.insert(manifest.inputs.end(), inputs.begin(), inputs.end());
  }
  apps::write_team(out, overwrite, manifest, run.task, run.drive, run.evaluation);
}

TeamRun replay_team(const TeamLog& log, const std::optional<fs::path>& out, bool overwrite, bool unknown_starts,
                    bool known_association) {
  apps::TeamTask task = apps::task_of(log.recording, unknown_starts, known_association);
  if (out && fs::exists(*out) && !overwrite && !(fs::is_directory(*out) && fs::is_empty(*out))) {
    throw core::InputError(out->string() + ": the folder is not empty");
  }
  task.quiet = true;
  SignalWatch signals;
  task.before_each_event = [&signals] { signals.heed(); };
  apps::TeamDrive drive = apps::drive_team(task);
  task.before_each_event = nullptr;
  apps::TeamEvaluation evaluation = apps::evaluate_team(task, drive);
  TeamRun run{std::move(task), std::move(drive), std::move(evaluation)};
  if (out) write_run(log, out->string(), overwrite, run);
  return run;
}

py::array_t<double> true_poses_of_member(const core::TeamMember& member) {
  py::array_t<double> rows({static_cast<py::ssize_t>(member.recording.true_poses.size()), py::ssize_t{4}});
  double* to = rows.mutable_data();
  for (const core::TruePose& truth : member.recording.true_poses) {
    *to++ = core::seconds(truth.t_ns);
    for (const double number : {truth.T_world_robot.x_m, truth.T_world_robot.y_m, truth.T_world_robot.heading_rad})
      *to++ = number;
  }
  return rows;
}

void bind_log_parts(py::module_& module) {
  using core::TeamMember;
  py::class_<TeamMember>(module, "TeamMember", "One robot of a team: its own drive, and whom it saw.")
      .def_readonly("number", &TeamMember::number, "Its number in the log.")
      .def_property_readonly(
          "start", [](const TeamMember& m) { return m.recording.start; }, "The Pose at the start of its drive.")
      .def_property_readonly(
          "events", [](const TeamMember& m) { return m.recording.events; },
          "Odometry and Scan events in order; a copy.")
      .def_property_readonly(
          "labels", [](const TeamMember& m) { return m.recording.labels; },
          "For each scan, the identity of each observation, -1 for none.")
      .def_readonly("sightings", &TeamMember::sightings, "RobotSightings in time order.")
      .def_property_readonly("true_poses", &true_poses_of_member, "(N, 4): t, x, y, heading.");
  py::class_<TeamLog>(module, "TeamLog", "The drives of several robots in one world, on one clock.")
      .def_property_readonly(
          "name", [](const TeamLog& log) { return text_with_paths(log.recording.name); },
          "Name of the log or scenario.")
      .def_property_readonly(
          "robots", [](const TeamLog& log) { return log.recording.robots; }, "TeamMembers; a copy.")
      .def_property_readonly(
          "starts_known", [](const TeamLog& log) { return log.recording.starts_known; },
          "Whether the starts are known in a common frame.")
      .def_property_readonly(
          "remarks", [](const TeamLog& log) { return texts_with_paths(log.recording.remarks); },
          "What was repaired, left out or is doubtful, one sentence each.")
      .def("__len__", [](const TeamLog& log) { return log.recording.robots.size(); });
}

std::vector<core::StepReport> steps_of_robot(const TeamRun& run, std::size_t robot) {
  if (robot >= run.drive.robots.size()) throw py::index_error("no such robot");
  return run.drive.robots[robot].steps;
}

py::array_t<double> trajectory_of_robot(const TeamRun& run, std::size_t robot) {
  const std::vector<core::StepReport> steps = steps_of_robot(run, robot);
  py::array_t<double> rows({static_cast<py::ssize_t>(steps.size()), py::ssize_t{4}});
  double* to = rows.mutable_data();
  for (const core::StepReport& step : steps) {
    *to++ = core::seconds(step.t_ns);
    for (const double number : {step.pose.mean.x_m, step.pose.mean.y_m, step.pose.mean.heading_rad}) *to++ = number;
  }
  return rows;
}

Map map_in_run(const TeamRun& run, std::size_t robot) {
  steps_of_robot(run, robot);
  return {run.drive.team.map(static_cast<int>(robot))};
}

int component_of_robot(const TeamRun& run, std::size_t robot) {
  steps_of_robot(run, robot);
  return run.drive.robots[robot].component;
}

py::object summary_of(const TeamRun& run) {
  const std::string text = apps::team_summary(run.task, run.drive, run.evaluation);
  return py::module_::import("json").attr("loads")(text_with_paths(text));
}

void bind_team_run(py::module_& module) {
  py::class_<TeamRun>(module, "TeamRun",
                      "The drives of several robots, navigated in one map. Robots are given by index.")
      .def("steps", &steps_of_robot, py::arg("robot"),
           "A StepReport for each scan, in the frame of its component at the end.")
      .def("trajectory", &trajectory_of_robot, py::arg("robot"),
           "(N, 4): t, x, y, heading at each scan, as estimated then.")
      .def("map", &map_in_run, py::arg("robot"), "Landmarks of its component.")
      .def("component", &component_of_robot, py::arg("robot"), "Index of the component's first robot.")
      .def_property_readonly(
          "joins", [](const TeamRun& run) { return run.drive.team.joins(); }, "TeamJoins.")
      .def_property_readonly(
          "joins_taken_back", [](const TeamRun& run) { return run.drive.team.joins_taken_back(); }, "TakenBackJoins.")
      .def_property_readonly(
          "sightings", [](const TeamRun& run) { return run.drive.team.sightings(); }, "JudgedSightings.")
      .def("evaluate", &summary_of, "Errors against the log's truth, as in summary.json of the run folder.")
      .def(
          "explain", [](const TeamRun& run) { return apps::team_text(run.task, run.drive, run.evaluation); },
          "Robots, errors and joins, one line each.")
      .def("__len__", [](const TeamRun& run) { return run.drive.robots.size(); });
}

}  // namespace

void bind_team_log(py::module_& module) {
  using Released = py::call_guard<WithoutGil>;
  bind_log_parts(module);
  bind_team_run(module);
  module.def("read_team_log", &read_team_log, py::arg("path"), py::arg("robots") = std::vector<int>(),
             py::arg("options") = py::dict(),
             "Reads a log of several robots (MRCLAM): the robots with these numbers, or all. options: its noise, as "
             "{'mrclam.sigma_range_m': 0.2}, keys as in a configuration file.");
  module.def("simulate_team", &simulate_team, py::arg("robots") = 2, py::arg("seed") = 1, Released(),
             "Simulates several robots that see each other, in one world with known truth.");
  module.def("replay_team", &replay_team, py::arg("log"), py::arg("out") = py::none(), py::arg("overwrite") = false,
             py::arg("unknown_starts") = false, py::arg("known_association") = true, Released(),
             "Navigates all robots of a log in one map, as helixnav replay does; with `out`, writes the team's run "
             "folder. Without known_association, landmarks have no names and robots are joined by constellations. "
             "Ctrl-C ends it before anything is written.");
}

}  // namespace helixnav::python
