// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bind.hpp"
#include "common/fit_to_recording.hpp"
#include "configuration.hpp"
#include "gil.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "helixnav/sim/simulate.hpp"
#include "log.hpp"
#include "replay/blackout.hpp"
#include "replay/read_to_replay.hpp"

namespace helixnav::python {
namespace {

namespace fs = std::filesystem;

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Log fitted(core::Recording recording, const Configuration& configuration) {
  Log log;
  log.navigator = apps::fit_to_recording(configuration.settings, recording);
  log.fastslam = configuration.settings.fastslam;
  log.known_association = apps::goes_by_identities(configuration.settings);
  log.config = configuration.text + apps::in_force_text(configuration.settings, log.navigator, recording);
  log.recording = std::move(recording);
  return log;
}

std::vector<apps::Blackout> blackouts_from(const std::vector<std::pair<double, double>>& spans) {
  std::vector<apps::Blackout> blackouts;
  for (const auto& [begin_s, end_s] : spans) {
    if (!(begin_s < end_s)) throw core::PreconditionError("blackouts: expected (begin, end), the end after the begin");
    blackouts.push_back({begin_s, end_s});
  }
  return blackouts;
}

Log read_log(const fs::path& path, const std::optional<fs::path>& vehicle, const py::dict& options,
             const std::vector<std::pair<double, double>>& spans) {
  const std::vector<apps::Blackout> blackouts = blackouts_from(spans);
  Configuration configuration = configuration_of(options, vehicle.value_or(fs::path()).string(), path.string());
  const WithoutGil released;
  core::Recording recording = apps::read_to_replay(path.string(), configuration.settings).recording;
  std::vector<bool> withheld;
  if (!blackouts.empty()) withheld = apps::withhold(recording, blackouts);
  apps::apply_log_settings(recording, configuration.settings);
  Log log = fitted(std::move(recording), configuration);
  log.withheld = std::move(withheld);
  log.is_own_log = logs::recognise(path.string()) == logs::LogFormat::own;
  log.files.push_back(path.string());
  if (vehicle) log.files.push_back(vehicle->string());
  return log;
}

Log simulate(const std::string& scenario, std::uint64_t seed, const py::dict& options) {
  const Configuration configuration = configuration_of(options);
  const WithoutGil released;
  Log log = fitted(sim::simulate(sim::named_scenario(scenario), seed), configuration);
  log.seed = seed;
  return log;
}

Rows true_poses_of(const Log& log) {
  Rows rows(static_cast<Eigen::Index>(log.recording.true_poses.size()), 4);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const core::TruePose& truth = log.recording.true_poses[static_cast<std::size_t>(i)];
    rows.row(i) << core::seconds(truth.t_ns), truth.T_world_robot.vector().transpose();
  }
  return rows;
}

Rows true_positions_of(const Log& log) {
  Rows rows(static_cast<Eigen::Index>(log.recording.true_positions.size()), 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const core::TruePosition& truth = log.recording.true_positions[static_cast<std::size_t>(i)];
    rows.row(i) << core::seconds(truth.t_ns), truth.position_m.transpose();
  }
  return rows;
}

Rows true_landmarks_of(const Log& log) {
  Rows rows(static_cast<Eigen::Index>(log.recording.true_landmarks.size()), 2);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    rows.row(i) = log.recording.true_landmarks[static_cast<std::size_t>(i)].point_m.transpose();
  }
  return rows;
}

}  // namespace

void bind_log(py::module_& module) {
  py::class_<Log>(module, "Log", "A recorded or simulated drive, with the navigator options for its sensor.")
      .def_property_readonly(
          "name", [](const Log& log) { return text_with_paths(log.recording.name); }, "Name of the file or scenario.")
      .def_property_readonly(
          "start", [](const Log& log) { return log.recording.start; },
          "The Pose at the start of the drive, in the map frame.")
      .def_property_readonly(
          "events", [](const Log& log) { return log.recording.events; },
          "Odometry, Scan, AbsoluteFix and Lost events in order; a copy.")
      .def_property_readonly(
          "labels", [](const Log& log) { return log.recording.labels; },
          "For each scan, the identity of each observation, -1 for none; empty if the log has no identities.")
      .def_property_readonly("true_poses", &true_poses_of, "(N, 4): t, x, y, heading in the map frame.")
      .def_property_readonly("true_positions", &true_positions_of, "(N, 3): t, x, y in their own frame.")
      .def_property_readonly("true_landmarks", &true_landmarks_of, "(N, 2).")
      .def_property_readonly(
          "remarks", [](const Log& log) { return texts_with_paths(log.recording.remarks); },
          "What was repaired, left out or is doubtful, one sentence each.")
      .def_readonly("known_association", &Log::known_association, "Whether replay uses the labels as identities.")
      .def_property_readonly(
          "config", [](const Log& log) { return text_with_paths(log.config); },
          "The configuration in force, as helixnav config --dump writes it.")
      .def("__len__", [](const Log& log) { return log.recording.events.size(); });
  module.def("read_log", &read_log, py::arg("path"), py::arg("vehicle") = py::none(), py::arg("options") = py::dict(),
             py::arg("blackouts") = std::vector<std::pair<double, double>>(),
             "Reads a log as helixnav replay does; without `vehicle`, a log in your own format uses the vehicle.toml "
             "next to it. Options are keys and values as in a configuration file; scans within `blackouts`, each "
             "(begin, end) in seconds, are withheld from the navigator. InputError names file, line and column.");
  module.def("simulate", &simulate, py::arg("scenario") = "large-loop", py::arg("seed") = 1,
             py::arg("options") = py::dict(),
             "Simulates a drive through a world with known truth; the same seed gives the same drive.");
}

}  // namespace helixnav::python
