// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace helixnav::apps {

/// After this call SIGINT and SIGTERM only raise a flag, so that a run can finish its step and close its folder. A
/// second signal ends the program at once, and so does the first if nobody calls interrupted() within `patience` of it:
/// short where the run folder is written step by step, long where all of it would be lost.
void catch_interrupts(std::chrono::milliseconds patience = std::chrono::milliseconds(700));

/// Whether the program is to stop as soon as it can.
bool interrupted();

/// Likewise, for one thread of several: the program is ended all the same if not all of them finish in time.
bool interrupt_pending();

}  // namespace helixnav::apps
