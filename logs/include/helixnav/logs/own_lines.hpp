// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "helixnav/core/recording.hpp"

namespace helixnav::logs {

/// JSON Lines are ordered by time, and rows of one time are one scan; a rawlog has frames with the same stamp and
/// motion between them. Moves each such event to a nanosecond after the one before it; returns how many there were.
/// Test: logs/own/own_lines_test.cpp.
std::size_t tell_times_apart(core::Recording& recording);

/// The recording as JSON Lines of the user's own schema (docs/your_own_log.md): increments and detections with their
/// covariances, labels as id, classes and sizes, times at which the vehicle was carried, truth. One line per event, in
/// order. If times tell the events apart, reading it back restores everything except the sensors, which are in the
/// vehicle file, and the correlation of a range with its bearing, which the schema does not hold. PreconditionError for
/// fixes among the events.
std::string own_lines(const core::Recording& recording);

/// The vehicle.toml that goes with the lines: where the sensor is and what it sees. The lines contain everything else.
/// core::InputError for scans by several sensors, which have no names in a recording. Test:
/// logs/own/own_lines_test.cpp.
std::string vehicle_of_lines(const core::Recording& recording);

}  // namespace helixnav::logs
