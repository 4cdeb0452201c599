// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// A warning where scans lie so far apart that most landmarks are in view of two of them at most: the way between two scans (median)
/// against the length of the way along which a scan shows landmarks (from the 5 % to the 95 % quantile, ahead of the robot). Else empty,
/// and of a run whose scans are not known. Test: reports/scans_apart_test.cpp.
std::string scans_apart_text(const runs::Run& run);

}  // namespace helixnav::reports
