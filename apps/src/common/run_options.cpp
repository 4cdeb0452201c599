// SPDX-License-Identifier: BSD-3-Clause
#include "run_options.hpp"

#include <filesystem>
#include <vector>

#include <CLI/CLI.hpp>

#include "drive/drive.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"
#include "helixnav/files/folder_lock.hpp"
#include "settings/config_file.hpp"
#include "settings/settings.hpp"

namespace helixnav::apps {
namespace {

std::vector<std::string>& command_line() {
  static std::vector<std::string> words;
  return words;
}

}  // namespace

void remember_command_line(int argc, char** argv) { command_line().assign(argv, argv + argc); }

std::string command_line_text() { return runs::command_text(command_line()); }

void add_folder_options(CLI::App& command, RunOptions& options) {
  command.add_option("--out", options.out, "Run folder to write; must be empty or new")->required()->type_name("DIR");
  command.add_flag("--overwrite", options.overwrite, "Replace the files of an earlier run in --out");
  command.add_flag("--quiet", options.quiet, "No progress bar");
}

void add_run_options(CLI::App& command, RunOptions& options) {
  add_folder_options(command, options);
  command.add_option("--config", options.config, "INI or TOML file of the settings below (helixnav config --dump)")
      ->type_name("FILE");
}

void prepare_run(CLI::App& command, const RunOptions& options) {
  namespace fs = std::filesystem;
  if (!options.config.empty()) apply_config_file(command, options.config);
  if (options.out.empty()) return;
  if (!fs::exists(options.out)) return;
  if (!fs::is_directory(options.out))
    throw core::InputError(options.out + ": expected a folder for --out, found a file");
  const files::FolderLock nobody_writes_there(options.out);  // RunWriter takes the permanent one
  if (!options.overwrite && !fs::is_empty(options.out)) {
    throw core::InputError(options.out +
                           ": the folder is not empty; choose another --out, or --overwrite to replace the run in it");
  }
}

void fill_drive(Drive& drive, const RunOptions& options, const std::string& config) {
  drive.out = options.out;
  drive.overwrite = options.overwrite;
  drive.quiet = options.quiet;
  drive.manifest.version = core::version();
  drive.manifest.commit = core::commit();
  drive.manifest.command = command_line_text();
  drive.manifest.recording = drive.recording.name;
  drive.manifest.config = config;
}

void choose_filter(Drive& drive, const Settings& settings) {
  drive.fastslam = settings.fastslam;
  drive.known_association = goes_by_identities(settings);
  drive.memory_mb = settings.memory_mb;
}

}  // namespace helixnav::apps
