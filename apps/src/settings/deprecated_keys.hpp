// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace helixnav::apps {

/// For settings that a vehicle file also states: its key, e.g. "odometry.scale" for "victoria_park.speed_scale"; empty for
/// any other.
std::string vehicle_key_of(const std::string& setting);

/// A sentence with those that the command line or --config sets to other than their defaults, and the keys that replace
/// them; empty if there are none. To be called before a vehicle file sets them. Test: apps/own_log_test.cpp.
std::string deprecated_keys_given(const CLI::App& command);

/// The sentence on stderr, if there is one.
void warn_of_deprecated_keys(const CLI::App& command);

}  // namespace helixnav::apps
