// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::apps {

/// Scans before which the vehicle slipped, as a run through the log decided, ascending.
std::vector<std::size_t> slipped_scans(const std::vector<core::StepReport>& steps);

/// Slips among these scans: consecutive ones, with at most two others between them, count as one.
std::size_t count_slips(const std::vector<std::size_t>& scans);

/// Makes the odometry between each of these scans and the one before it so uncertain that it does not constrain the vehicle: the data for
/// noise estimation are split there. Such increments count as rows without an error, which makes the factor of n slipped scans of N too
/// small by n / 2N. Test: apps/calibrate/slipped_scans_test.cpp.
void loosen_odometry(const std::vector<std::size_t>& scans, core::Recording& recording);

}  // namespace helixnav::apps
