// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/own_log.hpp"

namespace helixnav::logs {

/// Reasons to doubt that a log is meant as written, one sentence with numbers each: units of time, speed, turns and
/// bearings, gaps, single rows far faster than the others, scans outside the time of the odometry, detections outside
/// the view that the vehicle states, a reach far beyond all of them, hardly any detections, bearings or turns counted
/// clockwise. O(rows log rows + scans observations²). Test: logs/own/own_doubts_test.cpp.
std::vector<std::string> doubts_of(const OwnLog& log, const Vehicle& vehicle, const core::Recording& recording);

}  // namespace helixnav::logs
