// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "common/exit_code.hpp"

namespace CLI {
class App;
}

namespace helixnav::apps {

/// Name, version and commit, and MRPT's version.
std::string version_text(const std::string& program);

/// Calls `run`, which parses the command line with `app` first, and turns exceptions into a line on stderr and an exit
/// code, as described in docs/adr/0005; exceptions from MRPT count as data errors. Help and version are printed.
int run_program(CLI::App& app, const std::function<ExitCode()>& run);

}  // namespace helixnav::apps
