// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/recording.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::apps {

/// Recorded range over true one, the same for all beacons, from the events alone: the scale that minimises the
/// navigator's innovations, as mean NIS per row over the whole log with known association. Tries 0.90 … 1.20 in steps
/// of 0.02, then Brent's method to 0.0005; about 22 drives through the log. Truth is not used.
/// Test: apps/fusing_test.cpp.
double estimate_range_scale(const core::Recording& recording, const supervisor::NavigatorOptions& options);

/// Divides every range by the scale.
void divide_ranges(core::Recording& recording, double scale);

}  // namespace helixnav::apps
