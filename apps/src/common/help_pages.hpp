// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace helixnav::apps {

/// The group of options that are keys of --config, too.
inline const char* const settings_group = "Settings (keys of --config)";

/// From now on, for commands added after it: --help fits on a screen because it leaves the settings out, which --help-all
/// shows.
void use_short_help(CLI::App& app);

/// `help COMMAND` as `COMMAND --help`, and as COMMAND alone where there is none of that name, which is then refused; other words as
/// they are.
std::vector<std::string> without_help_word(const CLI::App& app, std::vector<std::string> words);

}  // namespace helixnav::apps
