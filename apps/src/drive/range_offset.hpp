// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "helixnav/core/recording.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// The amount missing from every range, to be added as `range_offset_m`.
struct RangeOffset {
  double offset_m = 0.0;
  double sigma_m = 0.0;  ///< by the assumed noise, or by the residuals if these are larger
};

/// How a run that mapped by itself contradicts its ranges: as landmarks are passed, ranges that are too short move them towards
/// the vehicle from every side, and neither another place of the landmark nor other poses explain that. Odometry is not used:
/// poses of scans and landmarks are eliminated in turn, sixteen times, after which a slow drift remains that does not harm the
/// offset (it comes out too small, not too large). Empty if no range and bearing of a landmark of the map was matched. Cost: 16
/// passes over the pairs, after the run. Test: apps/range_offset_test.cpp.
std::optional<RangeOffset> range_offset_of(const core::Recording& recording, const runs::Run& run);

}  // namespace helixnav::apps
