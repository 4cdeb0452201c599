// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "bind.hpp"
#include "common/chosen_navigator.hpp"
#include "common/joint_map_of.hpp"
#include "common/timed.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/event_loop.hpp"
#include "helixnav/core/version.hpp"
#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/reports/explanation.hpp"
#include "helixnav/reports/finish_run.hpp"
#include "helixnav/reports/summary.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "helixnav/runs/run_recorder.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "log.hpp"
#include "map.hpp"

namespace helixnav::python {
namespace {

namespace fs = std::filesystem;

runs::RunManifest manifest_of(const Log& log) {
  runs::RunManifest manifest;
  manifest.version = core::version();
  manifest.commit = core::commit();
  manifest.command = "python: helixnav.replay";
  manifest.recording = log.recording.name;
  manifest.config = log.config;
  manifest.seed = log.seed;
  return manifest;
}

/// Ctrl-C, now and then.
void heed_signals(std::int64_t step) {
  if (step % 256 != 0) return;
  const py::gil_scoped_acquire acquired;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

/// Feeds all events. What broke of the mathematics, and where; empty when nothing did.
std::string navigate(const Log& log, apps::ChosenNavigator& navigator, runs::RunWriter* writer,
                     runs::RunRecorder& recorder) {
  apps::Timed timed(navigator);
  core::EventLoop loop(log.recording.events, timed);
  try {
    while (const std::optional<core::StepReport> step = loop.next()) {
      if (writer != nullptr) writer->write(*step, 1e6 * timed.last_s());
      recorder.add(*step, 1e6 * timed.last_s());
      heed_signals(step->step);
    }
  } catch (const core::NumericalError& error) {
    const double t_s = core::seconds(core::time_of(log.recording.events[loop.fed() - 1]));
    return "at step " + std::to_string(loop.steps()) + ", " + std::to_string(t_s) + " s: " + error.what();
  }
  return {};
}

runs::Run replay(const Log& log, const std::optional<fs::path>& out, bool overwrite) {
  if (log.known_association && log.recording.labels.empty()) {
    throw core::InputError(log.recording.name + ": association known needs a labelled log, and this one has no labels");
  }
  using IfNotEmpty = runs::RunWriter::IfNotEmpty;
  const runs::RunManifest manifest = manifest_of(log);
  const std::string folder = out.value_or(fs::path()).string();
  std::unique_ptr<runs::RunWriter> writer;
  if (out) {
    writer = std::make_unique<runs::RunWriter>(folder, manifest, log.recording,
                                               overwrite ? IfNotEmpty::overwrite : IfNotEmpty::refuse);
  }
  runs::RunRecorder recorder(folder, manifest, log.recording);
  apps::ChosenNavigator navigator(log.recording, log.navigator, log.known_association);
  const std::string broken = navigate(log, navigator, writer.get(), recorder);
  runs::Run run = recorder.finish(navigator.map());
  if (writer) run.joint_map = apps::joint_map_of(navigator, log.recording);
  if (writer) reports::finish_run(run, *writer);
  if (!broken.empty()) throw core::NumericalError(broken);
  return run;
}

py::object evaluation_of(const runs::Run& run) {
  std::string text;
  {
    const py::gil_scoped_release released;
    text = reports::evaluation_json(evaluation::evaluate(run));
  }
  return py::module_::import("json").attr("loads")(text);
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

}  // namespace

void bind_run(py::module_& module) {
  py::class_<runs::Run>(module, "Run", "A drive that was navigated: what helixnav replay writes into a run folder.")
      .def_readonly("path", &runs::Run::path, "Its folder; empty without one.")
      .def_readonly("steps", &runs::Run::steps, "A StepReport for each scan.")
      .def_property_readonly("trajectory", &trajectory_of, "(N, 4): t, x, y, heading at each scan, as estimated then.")
      .def_property_readonly("map", [](const runs::Run& run) { return Map{run.map}; })
      .def("evaluate", &evaluation_of, "Errors against the truth of the log, as helixnav evaluate --json.")
      .def("explain", &reports::explain_run, "How many loops were closed, refused or left open, in sentences.")
      .def("__len__", [](const runs::Run& run) { return run.steps.size(); });
  module.def(
      "replay", &replay, py::arg("log"), py::arg("out") = py::none(), py::arg("overwrite") = false,
      py::call_guard<py::gil_scoped_release>(),
      "Navigates along a log. With `out`, a run folder is written as helixnav replay writes it. NumericalError names "
      "step and time; what was navigated until then is in the run folder.");
  module.def(
      "read_run", [](const fs::path& path) { return runs::read_run(path.string()); }, py::arg("path"),
      py::call_guard<py::gil_scoped_release>(), "Reads a run folder, also one whose run was killed.");
  module.def("evaluate", &evaluation_of, py::arg("run"), "As Run.evaluate.");
  module.def("evaluate", &evaluation_of_folder, py::arg("run"), "Of the run folder at a path.");
}

}  // namespace helixnav::python
