// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace helixnav::apps {

/// The group of options that are also keys of --config.
inline const char* const settings_group = "Settings (keys of --config)";

/// Applies to commands added after this call: --help fits on a screen because it leaves out the settings, which
/// --help-all shows.
void use_short_help(CLI::App& app);

/// Turns `help COMMAND` into `COMMAND --help`, or into COMMAND alone if there is no such command, which is then refused; other
/// words are unchanged.
std::vector<std::string> without_help_word(const CLI::App& app, std::vector<std::string> words);

}  // namespace helixnav::apps
