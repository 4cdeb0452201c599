// SPDX-License-Identifier: BSD-3-Clause
#include "suit_to_log.hpp"

#include <string>
#include <variant>

#include <CLI/CLI.hpp>

#include "helixnav/logs/read_recording.hpp"
#include "helixnav/supervisor/scale_lengths.hpp"

namespace helixnav::apps {
namespace {

void set_unless_given(CLI::App& command, const std::string& name, const std::string& value) {
  CLI::Option* option = command.get_option(name);
  if (option->count() > 0) return;
  option->add_result(value);
  option->run_callback();
}

/// Markers of the DLR logs: a camera that sees 3 m far where the defaults belong to a sensor that sees 30 m.
void search_among_markers(supervisor::SearchOptions& search) {
  search = supervisor::scale_lengths(search, 0.1);
  constexpr double view_m2 = 5.6;           // 1 to 3 m, ±0.7 rad
  constexpr double foreign_per_scan = 0.5;  // the navigator begins 0.26 landmarks a scan, clutter included
  search.foreign_per_scan = foreign_per_scan;
  search.relocalizer.sensor.extraneous_per_scan = foreign_per_scan;
  search.rivals.extraneous_per_m2 = foreign_per_scan / view_m2;
}

/// Reflectors: hardly anything else shines (22 landmarks begun in 586 scans), and there are too few to search among.
void search_among_reflectors(supervisor::SearchOptions& search) { search.foreign_per_scan = 0.5; }

}  // namespace

void suit_to_log(CLI::App& command, const std::filesystem::path& log, supervisor::SearchOptions& search) {
  const logs::LogFormat format = logs::recognise(log);
  if (format == logs::LogFormat::car_park_mat) search_among_reflectors(search);
  if (format != logs::LogFormat::dlr) return;
  const bool own_cells = command.get_option("--filter.cell_side_m")->count() > 0;
  set_unless_given(command, "--filter.cell_side_m", "4");
  if (!own_cells) set_unless_given(command, "--filter.hysteresis_m", "1.5");
  search_among_markers(search);
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
