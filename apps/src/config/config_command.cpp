// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "settings/config_file.hpp"
#include "settings/settings.hpp"

namespace helixnav::apps {
namespace {

struct ConfigJob {
  bool dump = false;
  std::string check;
  Settings settings;
};

void config(CLI::App& command, const ConfigJob& job) {
  if (!job.check.empty()) apply_config_file(command, job.check);
  if (job.dump) {
    std::fputs(dump_config(command).c_str(), stdout);
  } else {
    std::printf("%s: every key is known and in range\n", job.check.c_str());
  }
}

}  // namespace

void add_config_command(CLI::App& app, ExitCode&) {
  CLI::App* command = app.add_subcommand("config", "Print the settings, or check a configuration file");
  const auto job = std::make_shared<ConfigJob>();
  command->add_flag("--dump", job->dump, "Print all settings with their values as a file for --config");
  command->add_option("--check", job->check, "Read FILE and say whether every key is known and in range")
      ->type_name("FILE");
  add_settings(*command, job->settings);
  command->footer(
      "Examples:\n"
      "  helixnav config --dump > helixnav.toml\n"
      "  helixnav config --check helixnav.toml\n"
      "  helixnav config --dump --check mine.ini    # what a file makes of the settings\n");
  command->callback([command, job] {
    if (!job->dump && job->check.empty()) throw CLI::RequiredError("--dump or --check FILE");
    config(*command, *job);
  });
}

}  // namespace helixnav::apps
