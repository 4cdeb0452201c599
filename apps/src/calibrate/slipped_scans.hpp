// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::apps {

/// Scans before which the vehicle slipped, as a run through the log decided, ascending.
std::vector<std::size_t> slipped_scans(const std::vector<core::StepReport>& steps);

/// Slips of these scans: those one after the other, with at most two others between, are one.
std::size_t count_slips(const std::vector<std::size_t>& scans);

/// Makes the odometry between each of these scans and the one before it so uncertain that it says nothing of where the vehicle went: what
/// noise is estimated from is cut there. Such increments count as rows without an error, which makes the factor of n slipped scans of N
/// too small by n / 2N. Test: apps/calibrate/slipped_scans_test.cpp.
void loosen_odometry(const std::vector<std::size_t>& scans, core::Recording& recording);

}  // namespace helixnav::apps
