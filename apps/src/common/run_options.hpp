// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/runs/run_manifest.hpp"

namespace CLI {
class App;
}

namespace helixnav::apps {

struct Drive;
struct Settings;

/// Options of commands that write a run folder.
struct RunOptions {
  std::string out;
  std::string config;
  bool overwrite = false;
  bool quiet = false;
};

/// --out, --overwrite and --quiet: for every command that writes a run folder.
void add_folder_options(CLI::App& command, RunOptions& options);

/// These and --config: for the commands that navigate.
void add_run_options(CLI::App& command, RunOptions& options);

/// Applies --config and refuses an --out that is taken, before anything is read or computed. InputError for --out.
void prepare_run(CLI::App& command, const RunOptions& options);

/// Copies the options into the drive and begins its manifest; `config` is the configuration in force.
void fill_drive(Drive& drive, const RunOptions& options, const std::string& config);

/// The filter that the settings choose, whether labels are identities, and how much memory there is.
void choose_filter(Drive& drive, const Settings& settings);

/// The words of this process's command line, for the manifest.
void remember_command_line(int argc, char** argv);
/// The relevant ones, as one line.
std::string command_line_text();

}  // namespace helixnav::apps
