// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::apps {

/// What the program returns to the shell. `interrupted` follows the shell's custom of 128 + SIGINT.
enum class ExitCode : int { ok = 0, usage = 2, data = 3, numerical = 4, interrupted = 130 };

}  // namespace helixnav::apps
