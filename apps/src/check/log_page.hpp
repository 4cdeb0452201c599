// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/own_log.hpp"
#include "helixnav/logs/vehicle.hpp"

namespace helixnav::apps {

/// The tables of a log in the user's own format, in words: rows, times, rates, contents.
std::string tables_text(const logs::OwnLog& log);

/// The events of any log in words: path length and speed, scans, kinds of observations, reach and field of view seen and
/// stated, gaps, truth. For several sensors, seen and stated are given for each, by its name in the vehicle file if there
/// is one.
/// Test: apps/own_log_test.cpp.
std::string events_text(const core::Recording& recording, const logs::Vehicle* vehicle);

/// Whether all detections are range-only or bearing-only.
bool fixes_no_point(const core::Recording& recording);

}  // namespace helixnav::apps
