// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "helixnav/core/recording.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// How the corrections of a run drift with the distance driven. The innovations of a filter whose model is right have zero mean,
/// whatever the map; so have its corrections. A scale error of the odometry leaves a part of the distance in them, a misaligned sensor a
/// part of it across.
struct SystematicMotion {
  /// Of the odometry's distances, as a share of the corrected ones; negative: too short; 0 if all detections are bearings.
  double too_long = 0.0;
  double too_long_sigma = 0.0;
  double sideways_rad = 0.0;  ///< to the left of the odometry, as if the sensors looked this much farther to the right
  double sideways_sigma_rad = 0.0;
};

/// Sums of corrections over sums of distances, with the corrections' own scatter; those of single steps beyond six standard
/// deviations (slips, closings) are left out. The value across is a lower bound: the filter corrects a part of it by heading.
/// Errors of the odometry in turns are not estimated: scans correct these at once. Empty if fewer than 50 scans with matches
/// follow a motion forwards or back. Cost: a pass over steps and events, after the run. Test: apps/systematic_motion_test.cpp.
std::optional<SystematicMotion> systematic_motion_of(const core::Recording& recording, const runs::Run& run);

/// Adds to the run's numbers, from which reports and programs warn, the persistent errors that its detections show in the odometry,
/// and an offset of ranges (range_offset_of), if they are surely non-zero, besides what was taken out while driving. For a drive that mapped by itself with one filter.
void note_systematic_errors(const core::Recording& measured, runs::Run& run);

}  // namespace helixnav::apps
