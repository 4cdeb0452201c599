// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/events.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/logs/vehicle.hpp"

namespace helixnav::logs {

/// The user's own field of view; 0: what the log states, or what is estimated from it.
struct GivenFieldOfView {
  double max_range_m = 0.0;
  double width_rad = 0.0;  ///< all of it, as much on either side of straight ahead; 2π: all around
};

/// Field of view implied by the observations of a log, by quantiles, so that false detections do not count: nearest 1 %
/// of the ranges, three quarters of them up to max_range_m (beyond it a landmark may well be missed), 95 % up to
/// reach_m; bearings without 5 % on either side, all around if they go all around. The default (unknown) when no
/// observation fixes a point. O(n log n). Test: logs/field_of_view_test.cpp (a simulated sensor's own).
core::FieldOfView estimate_field_of_view(const core::Recording& recording);

/// Gives that estimate to every scan of a log that states nothing about its sensor (unlimited in range).
void estimate_missing_field_of_view(core::Recording& recording);

/// Overwrites the view of every scan with the given values. If a range is given, it is the reach as well.
void set_field_of_view(core::Recording& recording, const GivenFieldOfView& given);

/// Overwrites what a sensor states about its view. A reliable range alone says nothing of the reach: that remains, or is the reliable
/// range if none is known. Test: logs/field_of_view_test.cpp.
void tell_view(const SensorModel& sensor, core::FieldOfView& view);

/// That of the first scan whose reach is known, else of the first scan, else the default.
core::FieldOfView field_of_view_of(const core::Recording& recording);

}  // namespace helixnav::logs
