// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/own_log.hpp"

namespace helixnav::logs {

/// Truth and fixes of the log beside the events. True poses go into the map frame, whose origin is where the vehicle
/// stands at start_ns, when the first event begins; where nobody knows that, they are positions in their own frame, as fixes are.
void add_truth(const OwnLog& log, core::Nanoseconds start_ns, core::Recording& recording);

}  // namespace helixnav::logs
