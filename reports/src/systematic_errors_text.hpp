// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/decision.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// The errors that are not zero, as parts of a sentence.
std::string systematic_errors_text(const core::SystematicDecision& decision);

/// Warnings: what was taken out of the run while driving, and each constant that, by the run's numbers, is still missing for
/// ranges, odometry or mounting.
/// Test: reports/systematic_errors_text_test.cpp, apps/systematic_motion_test.cpp, apps/range_offset_test.cpp
std::vector<std::string> systematic_errors_texts(const runs::Run& run);

}  // namespace helixnav::reports
