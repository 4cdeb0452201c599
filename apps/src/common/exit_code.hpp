// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::apps {

/// What the program returns to the shell. `interrupted` is 128 + SIGINT, as is usual in shells.
enum class ExitCode : int { ok = 0, usage = 2, data = 3, numerical = 4, interrupted = 130 };

}  // namespace helixnav::apps
