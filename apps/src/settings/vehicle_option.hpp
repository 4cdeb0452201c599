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

/// --vehicle FILE: a vehicle.toml, or the name of a shipped one; `without` describes the default without it.
void add_vehicle_option(
    CLI::App& command, std::string& file,
    const std::string& without = "; default: vehicle.toml beside the log, or that of a published log");

/// The file of --vehicle, for the manifest; none if it is not given or is a shipped one.
std::vector<runs::InputFile> vehicle_inputs(const std::string& file);

/// As if the option had been given, unless it was.
void set_unless_given(CLI::App& command, const std::string& option_name, double value);

/// Reads the vehicle of a log, `file` (logs::find_vehicle) or else the vehicle.toml beside a log in the user's own format or
/// the one shipped for a published log, into the settings: its detection and fix parameters apply if neither the command line
/// nor --config set them. Nothing without one. Throws core::InputError for a file that cannot be used. Test:
/// apps/own_log_test.cpp.
void apply_vehicle(CLI::App& command, const std::string& file, const std::string& log, Settings& settings);

/// Applies a vehicle's sensor parameters to a recording not in the user's own format: the view alone if the format has taken
/// the rest (take_vehicle_of_log), else noise, too; its odometry is its own, except for noise_scale. Throws core::InputError
/// for what cannot be given for such a log. Test: apps/own_log_test.cpp, apps/shipped_vehicle_test.cpp.
void tell_vehicle(core::Recording& recording, logs::LogFormat format, const logs::Vehicle& vehicle);

/// The recording's remarks on stderr, one per line.
void print_remarks(const core::Recording& recording);

}  // namespace helixnav::apps
