// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/logs/read_recording.hpp"
#include "settings.hpp"

namespace helixnav::apps {

/// Whether take_vehicle_of_log takes the vehicles of logs of this format.
bool has_vehicle_model(logs::LogFormat format);

/// Takes a vehicle into the settings of a published format that has its own model (ACFR's truck, Plaza): its keys apply if
/// neither the command line nor --config gave the option of the same meaning (victoria_park.…, car_park.…, plaza.…, which are
/// deprecated). An [odometry] or a mounting that the file does not give stays that of the shipped vehicle. False for another
/// format. InputError for what this log's vehicle does not have. Test: apps/shipped_vehicle_test.cpp.
bool take_vehicle_of_log(CLI::App& command, logs::LogFormat format, const logs::Vehicle& vehicle, Settings& settings);

}  // namespace helixnav::apps
