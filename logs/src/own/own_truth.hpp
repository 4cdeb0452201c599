// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/own_log.hpp"

namespace helixnav::logs {

/// Where a recording begins: the origin of its map frame.
struct Beginning {
  core::Nanoseconds t_ns = 0;  ///< of the first event, at its end where that is an increment
  core::Pose2 T_start_first;   ///< the first increment where it ends there; identity where the first event is a scan
  core::Nanoseconds lasted_ns = 0;  ///< how long that increment took, as the next one did; 0 where nobody knows
};

/// Truth and fixes of the log beside the events. True poses go into the map frame, whose origin is where the vehicle
/// stands before the first event: the time of an increment's row is its end. Where nobody knows that, they are positions in
/// their own frame, as fixes are.
void add_truth(const OwnLog& log, const Beginning& beginning, core::Recording& recording);

}  // namespace helixnav::logs
