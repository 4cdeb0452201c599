// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bind.hpp"
#include "gil.hpp"
#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/reports/explanation.hpp"
#include "helixnav/reports/run_warnings.hpp"
#include "helixnav/reports/summary.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "log.hpp"
#include "map.hpp"
#include "replay.hpp"

namespace helixnav::python {
namespace {

namespace fs = std::filesystem;

/// "unknown", "end" or a pose (x, y, heading).
std::optional<apps::SessionStart> start_from(const py::object& value) {
  if (value.is_none()) return std::nullopt;
  if (!py::isinstance<py::str>(value)) {
    const core::Pose2 T(vector3_from(value, "start"));
    core::check_start({T, Eigen::Matrix3d::Zero()});
    return apps::SessionStart{apps::SessionStart::Kind::pose, T};
  }
  const std::string word = value.cast<std::string>();
  if (word == "unknown") return apps::SessionStart{};
  if (word == "end") return apps::SessionStart{apps::SessionStart::Kind::end, {}};
  throw core::PreconditionError("start: expected 'unknown', 'end' or a pose (x, y, heading), found '" + word + "'");
}

std::optional<OldMap> map_from(const py::object& value) {
  if (value.is_none()) return std::nullopt;
  if (py::isinstance<core::JointMap>(value)) return OldMap{value.cast<core::JointMap>(), {}};
  return OldMap{std::nullopt, path_from(value, "map")};
}

runs::Run replay_as_asked(const Log& log, const std::optional<fs::path>& out, bool overwrite, const py::object& map,
                          const py::object& start, bool localize, bool smooth) {
  ReplayWishes wishes;
  wishes.out = out.value_or(fs::path()).string();
  wishes.overwrite = overwrite;
  wishes.map = map_from(map);
  wishes.start = start_from(start);
  wishes.localize = localize;
  wishes.smooth = smooth;
  const WithoutGil released;
  return replay(log, wishes);
}

py::object evaluation_of(const runs::Run& run) {
  std::string text;
  {
    const WithoutGil released;
    text = reports::evaluation_json(evaluation::evaluate(run));
  }
  return py::module_::import("json").attr("loads")(text_with_paths(text));
}

py::list warnings_of(const runs::Run& run) {
  std::vector<std::string> warnings;
  {
    const WithoutGil released;
    warnings = reports::warnings_of(run, evaluation::evaluate(run));
    for (std::string& warning : reports::warnings_of_place(run)) warnings.push_back(std::move(warning));
  }
  return texts_with_paths(warnings);
}

py::object evaluation_of_folder(const fs::path& path) { return evaluation_of(runs::read_run(path.string())); }

py::array_t<double> trajectory_of(const runs::Run& run) {
  py::array_t<double> rows({static_cast<py::ssize_t>(run.steps.size()), py::ssize_t{4}});
  double* to = rows.mutable_data();
  for (const core::StepReport& step : run.steps) {
    *to++ = core::seconds(step.t_ns);
    *to++ = step.pose.mean.x_m;
    *to++ = step.pose.mean.y_m;
    *to++ = step.pose.mean.heading_rad;
  }
  return rows;
}

/// At the times of the trajectory.
py::array_t<double> final_trajectory_of(const runs::Run& run) {
  py::array_t<double> rows = trajectory_of(run);
  double* to = rows.mutable_data();
  for (std::size_t k = 0; k < run.final_path.size(); ++k) {
    const core::Pose2& pose = run.final_path[k];
    to[4 * k + 1] = pose.x_m;
    to[4 * k + 2] = pose.y_m;
    to[4 * k + 3] = pose.heading_rad;
  }
  return rows;
}

py::dict figures_of(const runs::Run& run) {
  py::dict numbers;
  for (const auto& [name, value] : run.numbers) numbers[py::str(name)] = value;
  return numbers;
}

}  // namespace

void bind_run(py::module_& module) {
  py::class_<runs::Run>(module, "Run", "A navigated drive: what helixnav replay writes into a run folder.")
      .def_property_readonly(
          "path", [](const runs::Run& run) { return text_with_paths(run.path); },
          "The run folder; empty if there is none.")
      .def_readonly(
          "steps", &runs::Run::steps,
          "A StepReport for each scan. Poses from before a session or a part of the drive found its place are "
          "moved into the frame of the map; their covariances remain those since the part began.")
      .def_property_readonly(
          "trajectory", &trajectory_of,
          "(N, 4): t, x, y, heading at each scan, as estimated then. Scans before a session or a part of "
          "the drive found its place are moved into the frame of the map.")
      .def_property_readonly(
          "map", [](const runs::Run& run) { return Map{run.map}; }, "The landmarks at the end, in the map frame.")
      .def_readonly("joint_map", &runs::Run::joint_map,
                    "The JointMap to continue in; None for a run that was read (use read_map), that only localised or "
                    "that used FastSLAM, and above 2000 landmarks if the drive was not "
                    "kept.")
      .def_property_readonly(
          "final_trajectory", &final_trajectory_of,
          "(N, 4): the trajectory as known at the end; equal to trajectory where nothing corrected it.")
      .def_property_readonly("numbers", &figures_of, "Figures from smoothing and from a given map, by name.")
      .def("evaluate", &evaluation_of, "Errors against the log's truth, as in helixnav evaluate --json.")
      .def(
          "explain", [](const runs::Run& run) { return text_with_paths(reports::explain_run(run)); },
          "Says in sentences how many loops were closed, refused or left open.")
      .def("warnings", &warnings_of,
           "What is wrong, one sentence each, as helixnav replay reports it. For a run that was read, without what "
           "only the log shows: constants that are wrong throughout.")
      .def("__len__", [](const runs::Run& run) { return run.steps.size(); });
  module.def("replay", &replay_as_asked, py::arg("log"), py::arg("out") = py::none(), py::arg("overwrite") = false,
             py::arg("map") = py::none(), py::arg("start") = py::none(), py::arg("localize") = false,
             py::arg("smooth") = false,
             "Navigates along a log with the filter chosen by its options. With `out`, writes a run folder as helixnav "
             "replay does. `map`, the folder of an earlier run or a JointMap, is continued in, or with `localize` left "
             "unchanged while only the pose is estimated in it (map.csv is then enough); `start` on it is 'unknown', "
             "'end' or a pose (x, y, heading). `smooth`: least squares over the filter's own associations afterwards. "
             "NumericalError names step and time; what was navigated until then is in the run folder.");
  module.def(
      "read_run", [](const fs::path& path) { return runs::read_run(path.string()); }, py::arg("path"),
      py::call_guard<WithoutGil>(), "Reads a run folder, even if its run was killed.");
  module.def("evaluate", &evaluation_of, py::arg("run"), "The same as Run.evaluate.");
  module.def("evaluate", &evaluation_of_folder, py::arg("run"), "Evaluates the run folder at a path.");
}

}  // namespace helixnav::python
