// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace helixnav::apps {

/// "section.key" of such an option.
std::string key_of(const CLI::Option& option);

/// The options of `app` that a configuration file may set: those with a dot in their name, `--section.key`.
std::vector<CLI::Option*> configurable_options(const CLI::App& app);

/// Those of them that the command line sets; to be called before apply_config_file.
std::set<const CLI::Option*> options_given(const CLI::App& app);

/// Sets from an INI or TOML file every configurable option that the command line left alone. Throws CLI::ValidationError
/// that names file, line and key, with the nearest key for an unknown one or the allowed range for a bad value.
void apply_config_file(CLI::App& app, const std::string& path);

/// All configurable options with their current values, as a file that apply_config_file reads back, one comment per
/// key.
/// Test: apps/config_test.cpp (round trip).
std::string dump_config(const CLI::App& app);

}  // namespace helixnav::apps
