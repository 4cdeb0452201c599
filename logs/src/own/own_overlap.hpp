// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/own_log.hpp"

namespace helixnav::logs {

/// The mean time between rows, given the first and the last.
core::Nanoseconds mean_interval_ns(core::Nanoseconds first_ns, core::Nanoseconds last_ns, std::size_t rows);

/// Until when increments and poses determine where a scan was taken: a mean interval beyond the last row. Speeds are
/// held.
core::Nanoseconds told_until_ns(core::Nanoseconds first_ns, core::Nanoseconds last_ns, std::size_t rows);

/// Adds a sentence with number and times of the scans more than a mean interval before the odometry begins, and one for
/// those that long after it ends. Test: logs/own/own_overlap_test.cpp.
void doubt_overlap(const OwnLog& log, const core::Recording& recording, std::vector<std::string>& doubts);

}  // namespace helixnav::logs
