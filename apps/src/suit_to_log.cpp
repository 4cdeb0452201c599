// SPDX-License-Identifier: BSD-3-Clause
#include "suit_to_log.hpp"

#include <string>
#include <variant>

#include <CLI/CLI.hpp>

#include "helixnav/logs/read_recording.hpp"

namespace helixnav::apps {
namespace {

void set_unless_given(CLI::App& command, const std::string& name, const std::string& value) {
  CLI::Option* option = command.get_option(name);
  if (option->count() > 0) return;
  option->add_result(value);
  option->run_callback();
}

}  // namespace

void suit_to_log(CLI::App& command, const std::filesystem::path& log) {
  if (logs::recognise(log) != logs::LogFormat::dlr) return;
  const bool own_cells = command.get_option("--filter.cell_side_m")->count() > 0;
  set_unless_given(command, "--filter.cell_side_m", "4");
  if (!own_cells) set_unless_given(command, "--filter.hysteresis_m", "1.5");
}

void scale_covariances(core::Recording& recording, double scale) {
  for (core::Event& event : recording.events) {
    if (auto* odometry = std::get_if<core::Odometry>(&event)) odometry->covariance *= scale;
    if (auto* scan = std::get_if<core::Scan>(&event)) {
      for (core::Observation& observation : scan->observations) observation.R *= scale;
    }
  }
}

}  // namespace helixnav::apps
