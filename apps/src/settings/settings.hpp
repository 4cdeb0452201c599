// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fastslam_settings.hpp"
#include "helixnav/association/associate.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "replay/fuse_gps.hpp"

namespace CLI {
class App;
}

namespace helixnav::apps {

/// Everything that a configuration file may set, bound to the options --section.key of a command.
struct Settings {
  supervisor::NavigatorOptions navigator;
  FastSlamSettings fastslam;         ///< instead of the navigator, if chosen
  bool known_association = false;    ///< association.method is "known": the log's labels are the identities
  bool unknown_association = false;  ///< it is "unknown": for a team log, whose identities replay otherwise uses
  logs::RecordingSettings logs;
  std::map<std::string, double> given_lengths_m;  ///< by their names in supervisor/lengths.cpp; all others by the reach
  logs::GivenFieldOfView field_of_view;
  double covariance_scale = 1.0;   ///< on the covariances stated in the log or given by its sensor settings
  double plaza_range_scale = 0.0;  ///< 0: estimate it from the log
  GpsSettings gps;
  std::optional<double> names_wrong;  ///< NavigatorOptions::names; nothing: by the log
  double memory_mb = 0.0;             ///< at which a drive ends; 0: no limit
};

/// Whether the chosen filter takes the labels of the log as identities.
bool goes_by_identities(const Settings& settings);

/// All association methods, in the order in which to show them.
std::vector<association::Method> association_methods();

/// Adds one option per key, with unit, range and default in its help.
void add_settings(CLI::App& command, Settings& settings);

}  // namespace helixnav::apps
