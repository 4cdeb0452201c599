// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::apps {

/// From now on SIGINT and SIGTERM only raise a flag, so that a run can finish its step and close its folder. A second
/// signal ends the program at once.
void catch_interrupts();

bool interrupted();

}  // namespace helixnav::apps
