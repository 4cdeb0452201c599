// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "helixnav/core/recording.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// How the corrections of a run drift along with the way driven. The innovations of a filter whose model is right have mean zero,
/// whatever the map; so have its corrections. A scale of the odometry leaves a part of the way in them, a sensor that looks aside a part
/// of it across.
struct SystematicMotion {
  double too_long = 0.0;  ///< of the odometry's ways, as a share of the corrected ones; negative: too short
  double too_long_sigma = 0.0;
  double sideways_rad = 0.0;  ///< to the left of the odometry, as if the sensors looked so much farther to the right
  double sideways_sigma_rad = 0.0;
};

/// Sums of corrections by sums of ways, with the corrections' own scatter; those of single steps beyond six standard deviations
/// (slips, closings) are left out. What is across is a bound from below: the filter corrects a part of it by heading. Of a turn that
/// the odometry gets wrong it says nothing: scans set that right at once. Empty where fewer than 50 scans with matches lie behind a
/// motion forwards or back. Cost: a pass over steps and events, after the run. Test: apps/systematic_motion_test.cpp.
std::optional<SystematicMotion> systematic_motion_of(const core::Recording& recording, const runs::Run& run);

/// Into the run's numbers, by which reports and programs warn, what its detections say against the odometry all along, of that and of
/// an offset of ranges (range_offset_of): where it is surely not nought. For a drive that mapped by itself with one filter.
void note_systematic_errors(const core::Recording& recording, runs::Run& run);

}  // namespace helixnav::apps
