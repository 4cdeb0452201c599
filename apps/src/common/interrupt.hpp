// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::apps {

/// From now on SIGINT and SIGTERM only raise a flag, so that a run can finish its step and close its folder. A second
/// signal ends the program at once, and so does the first when nobody asks interrupted() within 0.7 s of it.
void catch_interrupts();

/// The program stops as soon as it can what it does.
bool interrupted();

/// Likewise, for one thread of several: the program is ended all the same when not all of them come to an end in time.
bool interrupt_pending();

}  // namespace helixnav::apps
