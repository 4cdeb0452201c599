// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "bind.hpp"
#include "common/chosen_navigator.hpp"
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

runs::Run replay(const Log& log, const std::optional<fs::path>& out, bool overwrite) {
  if (log.known_association && log.recording.labels.empty()) {
    throw core::InputError(log.recording.name + ": association known needs a labelled log, and this one has no labels");
  }
  using IfNotEmpty = runs::RunWriter::IfNotEmpty;
  const runs::RunManifest manifest = manifest_of(log);
  std::unique_ptr<runs::RunWriter> writer;
  if (out) {
    writer = std::make_unique<runs::RunWriter>(out->string(), manifest, log.recording,
                                               overwrite ? IfNotEmpty::overwrite : IfNotEmpty::refuse);
  }
  runs::RunRecorder recorder(out.value_or(fs::path()).string(), manifest, log.recording);
  apps::ChosenNavigator navigator(log.recording, log.navigator, log.known_association);
  apps::Timed timed(navigator);
  core::EventLoop loop(log.recording.events, timed);
  while (const std::optional<core::StepReport> step = loop.next()) {
    if (writer) writer->write(*step, 1e6 * timed.last_s());
    recorder.add(*step, 1e6 * timed.last_s());
    heed_signals(step->step);
  }
  runs::Run run = recorder.finish(navigator.map());
  if (writer) reports::finish_run(run, *writer);
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

py::object evaluate(const std::variant<const runs::Run*, fs::path>& what) {
  if (const auto* run = std::get_if<const runs::Run*>(&what)) return evaluation_of(**run);
  return evaluation_of(runs::read_run(std::get<fs::path>(what).string()));
}

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
  module.def("replay", &replay, py::arg("log"), py::arg("out") = py::none(), py::arg("overwrite") = false,
             py::call_guard<py::gil_scoped_release>(),
             "Navigates along a log. With `out`, a run folder is written as helixnav replay writes it.");
  module.def(
      "read_run", [](const fs::path& path) { return runs::read_run(path.string()); }, py::arg("path"),
      py::call_guard<py::gil_scoped_release>(), "Reads a run folder, also one whose run was killed.");
  module.def("evaluate", &evaluate, py::arg("run"), "Of a Run or of the run folder at a path.");
}

}  // namespace helixnav::python
