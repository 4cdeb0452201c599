// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/recording.hpp"
#include "settings.hpp"

namespace CLI {
class App;
}

namespace helixnav::apps {

/// --vehicle FILE: a vehicle.toml.
void add_vehicle_option(CLI::App& command, std::string& file);

/// Reads the vehicle of a log, `file` or else the vehicle.toml beside a log of the user's own, into the settings: what it
/// says of detection and fixes goes where neither the command line nor --config said otherwise. Nothing without one.
/// Throws core::InputError for a file that cannot be used. Test: apps/own_log_test.cpp.
void apply_vehicle(CLI::App& command, const std::string& file, const std::string& log, Settings& settings);

/// What a vehicle says of the sensor, into a recording of another format, which knows its own odometry. Throws
/// core::InputError for what cannot be given for such a log.
void tell_vehicle(core::Recording& recording, const logs::Vehicle& vehicle);

/// The recording's remarks on stderr, one a line.
void print_remarks(const core::Recording& recording);

}  // namespace helixnav::apps
