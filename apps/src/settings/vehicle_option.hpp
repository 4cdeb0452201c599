// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "helixnav/runs/run_manifest.hpp"
#include "settings.hpp"

namespace CLI {
class App;
}

namespace helixnav::apps {

/// --vehicle FILE: a vehicle.toml, or the name of one that ships; `without` says what holds when it is not given.
void add_vehicle_option(
    CLI::App& command, std::string& file,
    const std::string& without = "; default: vehicle.toml beside the log, or that of a published log");

/// The file of --vehicle, for the manifest; none where it is not given or ships.
std::vector<runs::InputFile> vehicle_inputs(const std::string& file);

/// As if the option had been given, unless it was.
void set_unless_given(CLI::App& command, const std::string& option_name, double value);

/// Reads the vehicle of a log, `file` (logs::find_vehicle) or else the vehicle.toml beside a log of the user's own or the one
/// that ships for a published log, into the settings: what it says of detection and fixes goes where neither the command line
/// nor --config said otherwise. Nothing without one.
/// Throws core::InputError for a file that cannot be used. Test: apps/own_log_test.cpp.
void apply_vehicle(CLI::App& command, const std::string& file, const std::string& log, Settings& settings);

/// What a vehicle says of the sensor, into a recording of another format than a log of the user's own: the view alone where
/// the format has taken the rest (take_vehicle_of_log), else noise, too; the odometry it knows itself, but for noise_scale.
/// Throws core::InputError for what cannot be given for such a log. Test: apps/own_log_test.cpp, apps/shipped_vehicle_test.cpp.
void tell_vehicle(core::Recording& recording, logs::LogFormat format, const logs::Vehicle& vehicle);

/// The recording's remarks on stderr, one a line.
void print_remarks(const core::Recording& recording);

}  // namespace helixnav::apps
