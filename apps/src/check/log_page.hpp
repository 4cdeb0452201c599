// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/own_log.hpp"
#include "helixnav/logs/vehicle.hpp"

namespace helixnav::apps {

/// The tables of a log of the user's own in words: rows, times, rates, what they say.
std::string tables_text(const logs::OwnLog& log);

/// The events of any log in words: way and speed, scans, kinds of observations, reach and field of view seen and stated,
/// gaps, truth. Of several sensors seen and stated are told of each, by its name in the vehicle file if there is one. Test:
/// apps/own_log_test.cpp.
std::string events_text(const core::Recording& recording, const logs::Vehicle* vehicle);

/// Whether all that is detected are ranges or bearings alone.
bool fixes_no_point(const core::Recording& recording);

}  // namespace helixnav::apps
