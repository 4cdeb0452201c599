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

/// Markers of the DLR logs: half of them have a neighbour within 0.85 m.
void search_among_markers(supervisor::SearchOptions& search) {
  constexpr double view_m2 = 5.6;           // 1 to 3 m, ±0.7 rad
  constexpr double foreign_per_scan = 0.5;  // the navigator begins 0.26 landmarks a scan, clutter included
  search.foreign_per_scan = foreign_per_scan;
  search.relocalizer.sensor.extraneous_per_scan = foreign_per_scan;
  search.rivals.extraneous_per_m2 = foreign_per_scan / view_m2;

  // Driven. Looks are as far apart as in the life of a landmark, the others as many views long as outdoors, or nearly.
  search.look_distance_m = 0.25;
  search.rest_m = 1.0;
  search.ask_again_m = 1.0;
  search.confirm_m = 0.5;
  search.branch_seen_within_m = 15.0;
  search.reach_m = 11.0;

  // One mode, one place and one marker are what lies within about half of the distance between markers.
  search.relocalizer.mode_radius.position_m = 0.4;
  search.relocalizer.bin_m = 0.1;
  search.gate.sigma_position_m = 0.15;
  search.rivals.apart_m = 0.5;
  search.rivals.distinct_m = 0.25;
  search.constellation.most_tolerance_m = 0.35;

  // Noise of a marker.
  search.constellation.branch_sigma_m = search.rivals.branch_sigma_m = 0.05;

  // Two drives with so narrow a view share little ground, and few markers are there to contradict a false pose: what
  // speaks against it is that it matches fewer.
  search.constellation.rival_match_share = 0.6;
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
