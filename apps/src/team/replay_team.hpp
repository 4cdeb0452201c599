// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "common/exit_code.hpp"
#include "common/run_options.hpp"
#include "common/settings.hpp"

namespace helixnav::apps {

/// Options of replay that only a log of several robots has.
struct TeamChoice {
  std::vector<int> robots;  ///< by number; empty: all
  bool unknown_starts = false;
};

/// Navigates all robots of a log in one map and writes the run folder of the team.
ExitCode replay_team(const std::string& path, const TeamChoice& choice, const RunOptions& run, const Settings& settings,
                     const std::string& config);

}  // namespace helixnav::apps
