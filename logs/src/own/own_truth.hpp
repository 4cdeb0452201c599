// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/own_log.hpp"

namespace helixnav::logs {

/// Where a recording starts: the origin of its map frame.
struct Beginning {
  core::Nanoseconds t_ns = 0;  ///< of the first event, at its end where that is an increment
  core::Pose2 T_start_first;   ///< the first increment if t_ns is its end; the identity where the first event is a scan
  core::Nanoseconds lasted_ns = 0;  ///< how long that increment took, taken from the next one; 0 if unknown
};

/// Truth and fixes of the log in addition to the events. True poses go into the map frame, whose origin is where the
/// vehicle is before the first event: the time of an increment's row is its end. If that is unknown, they are positions
/// in their own frame, as fixes are.
void add_truth(const OwnLog& log, const Beginning& beginning, core::Recording& recording);

}  // namespace helixnav::logs
