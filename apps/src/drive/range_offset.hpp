// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "helixnav/core/recording.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// What is missing from every range, to be added as `range_offset_m`.
struct RangeOffset {
  double offset_m = 0.0;
  double sigma_m = 0.0;  ///< by the noise assumed, or by what is left where that is more
};

/// How a run that mapped by itself contradicts its ranges: where landmarks are passed, too short a range moves one of them towards
/// the vehicle from every side, and neither another place of it nor other poses explain that. Odometry is not asked: poses of
/// scans and landmarks are taken out by turns, sixteen times, after which a slow drift remains that is of no harm to the offset
/// (it comes out too small, not too large). Empty where no range and bearing of a landmark of the map was matched. Cost: 16 passes
/// over the pairs, after the run. Test: apps/range_offset_test.cpp.
std::optional<RangeOffset> range_offset_of(const core::Recording& recording, const runs::Run& run);

}  // namespace helixnav::apps
