// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "helixnav/logs/read_recording.hpp"
#include "helixnav/logs/vehicle.hpp"

namespace helixnav::logs {

/// Names of the vehicles of published logs whose files are shipped: victoria_park, car_park, plaza, dlr.
std::vector<std::string> shipped_vehicle_names();

/// The text of such a file. InputError for another name, suggesting the nearest one.
std::string_view shipped_vehicle_text(const std::string& name);

/// The shipped vehicle for a format's logs; nothing if none is shipped.
std::optional<std::string> shipped_vehicle_of(LogFormat format);

/// The parsed file. The defaults of RecordingSettings are the same: apps/shipped_vehicle_test.cpp.
Vehicle shipped_vehicle(const std::string& name);

/// A vehicle file or, if no file has that name, the shipped vehicle of that name. InputError for what is neither,
/// listing the names there are. Test: logs/shipped_vehicle_test.cpp.
Vehicle find_vehicle(const std::string& file_or_name);

}  // namespace helixnav::logs
