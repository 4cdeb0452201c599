// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// A warning if scans are so far apart that most landmarks are in view of at most two of them: the distance between two scans (median)
/// compared with the path length along which a scan shows landmarks (from the 5 % to the 95 % quantile, ahead of the robot). Otherwise
/// empty, as also for a run whose scans are not known. Test: reports/scans_apart_test.cpp.
std::string scans_apart_text(const runs::Run& run);

}  // namespace helixnav::reports
