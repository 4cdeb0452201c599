// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// A warning for each constant that, by the run's numbers, is missing for ranges, odometry or
/// mounting.
/// Test: apps/systematic_motion_test.cpp, apps/range_offset_test.cpp
std::vector<std::string> systematic_errors_texts(const runs::Run& run);

}  // namespace helixnav::reports
