// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/exit_code.hpp"
#include "common/run_options.hpp"
#include "settings/settings.hpp"

namespace CLI {
class App;
}

namespace helixnav::apps {

/// Options of a command that apply only to several robots.
struct TeamChoice {
  std::vector<int> robots;  ///< of a log, by number; empty: all
  bool unknown_starts = false;
};

/// Refuses the given options and settings that several robots do not have.
void refuse_settings_of_one_robot(const GivenOptions& given, const Settings& settings);

/// Refuses those of the command's `options` and of the settings that only several robots have.
void refuse_options_of_a_team(const CLI::App& command, const std::vector<std::string>& options,
                              const Settings& settings);

/// Navigates all robots of a log in one map and writes the run folder of the team.
ExitCode replay_team(const std::string& path, const TeamChoice& choice, const RunOptions& run, const Settings& settings,
                     const std::string& config);

/// The same for simulated robots, each of which sees the others (sim::simulate_team).
ExitCode simulate_team(int robots, std::uint64_t seed, bool unknown_starts, const RunOptions& run,
                       const Settings& settings, const std::string& config);

}  // namespace helixnav::apps
